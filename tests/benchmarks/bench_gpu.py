"""On a GPU: training steps and queries of the thesis's network, frames of the papers' networks.

Beside the matrix products alone in the same number format, and the same work as plain PyTorch does
it: eagerly, in float32. A time is the median of many calls, each waited for.
"""

from collections.abc import Callable

import torch
from bench_queries import WIDTHS, thesis_network
from bench_screen import HEIGHT, NETWORKS, WIDTH
from bench_training import RandomRays
from measurement import Row, Work, median_seconds, name_of

from neural_shadows.frames.feature_names import channels_of
from neural_shadows.networks.screen_space.screen_forms import layers_of
from neural_shadows.networks.screen_space.screen_networks import make_screen_network
from neural_shadows.networks.screen_space.widths import total
from neural_shadows.networks.settings.networks import screen_network
from neural_shadows.training.batches import batch_indices
from neural_shadows.training.cuda_graph import recorded
from neural_shadows.training.training_run import TrainingRun

BATCH = 65_536  # [4.1]
FRAME_RAYS = 1 << 20
STEPS = 20  # of a training in one timed call
PRODUCT = 8192  # rows and columns of the matrices
# The paper's steps [Datta et al. 2022, 3.5]: `original` and `trimmed` of datta_2022.yaml.
STEPS_OF_NSM = {
    "NSM, original": NETWORKS["NSM, fast form"]
    | {"form": "original", "widths": [32, 64, 128, 256, 512]},
    "NSM, trimmed": NETWORKS["NSM, fast form"] | {"form": "full", "widths": [16, 32, 64, 128, 256]},
}
FRAMES = STEPS_OF_NSM | NETWORKS
DTYPES = (torch.float32, torch.bfloat16, torch.float16)


def rows(quick: bool) -> list[Row]:
    """Rates of all of it; none without a GPU."""
    if not torch.cuda.is_available():
        return []
    rounds = 5 if quick else 15
    cases = [(width, dtype) for width in WIDTHS for dtype in DTYPES]
    return [
        *(_training_row(*case, rounds) for case in cases),
        *(_query_row(*case, rounds) for case in cases),
        *(_frame_row(name, dtype, rounds) for name in FRAMES for dtype in DTYPES[:2]),
    ]


def _waited_for(work: Work) -> Work:
    def waited() -> None:
        work()
        torch.cuda.synchronize()

    return waited


def _products(width: int, dtype: torch.dtype, rows: int, backward: bool) -> Callable[[], None]:
    """The layers' matrix products of so many rays."""
    layers = []
    for weight in thesis_network(width).layers:
        into, out = weight.shape[1], weight.shape[0]
        x, y = (torch.randn(rows, size, device="cuda", dtype=dtype) for size in (into, out))
        layers.append((x, y, weight.detach().to("cuda", dtype)))

    def products() -> None:
        for i, (x, y, weight) in enumerate(layers):
            torch.mm(x, weight.t())
            if backward:
                torch.mm(y.t(), x)
                if i:  # nobody needs the gradient of the encoding
                    torch.mm(y, weight)

    return products


def _training_row(width: int, dtype: torch.dtype, rounds: int) -> Row:
    rays = RandomRays()
    rays.parts = type(rays.parts)(*(part.cuda() for part in rays.parts))

    def stepper(precision: str) -> Callable[[], None]:
        settings = {"optimiser": "adam", "learning_rate": 1e-4, "loss": {}, "steps": 1}
        settings |= {"batch_size": BATCH, "schedule": "constant", "seed": 0}
        run = TrainingRun(
            thesis_network(width), {**settings, "device": "cuda", "precision": precision}
        )

        def step() -> None:
            indices = batch_indices(run.step, seed=0, batch_size=BATCH, count=rays.count)
            run.train_step(rays.gather(indices))

        return step

    ours, plain = recorded(stepper(name_of(dtype))), stepper("float32")
    products = recorded(_products(width, dtype, BATCH, backward=True))
    works = {"ours": ours, "plain": plain, "products": products}
    for work in works.values():
        for _ in range(5):  # records
            work()
    many = {
        name: _waited_for(lambda work=work: [work() for _ in range(STEPS)])
        for name, work in works.items()
    }
    rate = {name: STEPS * BATCH / each for name, each in median_seconds(many, rounds).items()}
    return Row(
        f"training, width {width}, {name_of(dtype)}, batches of {BATCH}",
        torch.cuda.get_device_name(),
        rate["ours"],
        "samples/s",
        ceiling=rate["products"],
        peer="eager float32",
        peer_rate=rate["plain"],
    )


def _query_row(width: int, dtype: torch.dtype, rounds: int) -> Row:
    network = thesis_network(width).cuda()
    vectors = torch.nn.functional.normalize(torch.randn(FRAME_RAYS, 3, device="cuda"))
    d = vectors[0]
    with torch.inference_mode():
        works = {
            "ours": lambda: network.depths(vectors, d, dtype),
            "plain": lambda: network.depths(vectors, d, torch.float32),
            "products": _products(width, dtype, FRAME_RAYS, backward=False),
        }
        seconds = median_seconds({k: _waited_for(work) for k, work in works.items()}, rounds)
    rate = {name: FRAME_RAYS / each for name, each in seconds.items()}
    return Row(
        f"query, width {width}, {name_of(dtype)}",
        torch.cuda.get_device_name(),
        rate["ours"],
        "rays/s",
        ceiling=rate["products"],
        peer="float32",
        peer_rate=rate["plain"],
    )


def _frame_row(name: str, dtype: torch.dtype, rounds: int) -> Row:
    settings = screen_network(FRAMES[name])
    macs = total(layers_of(settings), "macs") * WIDTH * HEIGHT
    network = make_screen_network(settings).for_inference()
    network = network.to("cuda", dtype, memory_format=torch.channels_last)
    frame = torch.rand(1, channels_of(settings.features), HEIGHT, WIDTH).to("cuda", dtype)
    frame = frame.contiguous(memory_format=torch.channels_last)
    square = torch.rand(PRODUCT, PRODUCT, device="cuda").to(dtype)
    with torch.inference_mode():
        works = {
            "frame": lambda: network.in_bands(frame),
            "layers": lambda: network(frame),
            "product": lambda: square @ square,
        }
        seconds = median_seconds({k: _waited_for(work) for k, work in works.items()}, rounds)
    return Row(
        f"{name}, {WIDTH} x {HEIGHT}, {name_of(dtype)}",
        torch.cuda.get_device_name(),
        1 / seconds["frame"],
        "frames/s",
        ceiling=PRODUCT**3 / seconds["product"] / macs,
        peer="layer by layer",
        peer_rate=1 / seconds["layers"],
    )
