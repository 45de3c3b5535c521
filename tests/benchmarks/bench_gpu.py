"""On a GPU: training steps and queries of the thesis's network, frames of the papers' networks.

The ceiling is the matrix products alone in the same number format; of frames, products of large
matrices by their multiply-adds. Peers are eager float32. Each timed call is waited for.
"""

from collections.abc import Mapping

import bench_queries
import bench_training
import torch
from bench_queries import WIDTHS, thesis_network
from bench_screen import HEIGHT, NETWORKS, WIDTH
from measurement import Row, Work, median_seconds, name_of

from neural_shadows.frames.feature_names import channels_of
from neural_shadows.networks.screen_space.screen_forms import layers_of
from neural_shadows.networks.screen_space.screen_networks import make_screen_network
from neural_shadows.networks.screen_space.widths import total
from neural_shadows.networks.settings.networks import screen_network
from neural_shadows.training.cuda_graph import WARM_UP, recorded

GPU = torch.device("cuda")
BATCH = 65_536  # [4.1]
FRAME_RAYS = 1 << 20
STEPS = 20  # of a training in one timed call
PRODUCT = 8192  # rows and columns of the matrices
# `original` and `trimmed` of datta_2022.yaml [Datta et al. 2022, 3.5].
FAST = NETWORKS["NSM, fast form"]
FRAMES = {
    "NSM, original": FAST | {"form": "original", "widths": [32, 64, 128, 256, 512]},
    "NSM, trimmed": FAST | {"form": "full", "widths": [16, 32, 64, 128, 256]},
    **NETWORKS,
}
DTYPES = (torch.float32, torch.bfloat16, torch.float16)


def rows(quick: bool) -> list[Row]:
    """All rates; none without a GPU."""
    if not torch.cuda.is_available():
        return []
    rounds = 5 if quick else 15
    cases = [(width, dtype) for width in WIDTHS for dtype in DTYPES]
    return [
        *(_training_row(*case, rounds) for case in cases),
        *(_query_row(*case, rounds) for case in cases),
        *(_frame_row(name, dtype, rounds) for name in FRAMES for dtype in DTYPES[:2]),
    ]


def _training_row(width: int, dtype: torch.dtype, rounds: int) -> Row:
    rays = bench_training.RandomRays(GPU)
    run, plain = (
        bench_training.new_run(width, BATCH, precision, device=GPU)
        for precision in (name_of(dtype), "float32")
    )
    works = {
        "ours": recorded(bench_training.stepper(run, rays)),
        "plain": bench_training.stepper(plain, rays),
        "products": recorded(bench_training.products(run.network, dtype, BATCH)),
    }
    for work in works.values():
        for _ in range(WARM_UP + 1):
            work()
    seconds = _seconds(works, rounds, STEPS)
    stage = f"training, width {width}, {name_of(dtype)}, batches of {BATCH}"
    return _row(stage, BATCH, "samples/s", seconds, "eager float32")


def _query_row(width: int, dtype: torch.dtype, rounds: int) -> Row:
    network = thesis_network(width).to(GPU)
    origins = torch.nn.functional.normalize(torch.randn(FRAME_RAYS, 3, device=GPU))
    works = {
        "ours": lambda: network.depths(origins, origins[0], dtype),
        "plain": lambda: network.depths(origins, origins[0], torch.float32),
        "products": bench_queries.products(network, dtype, FRAME_RAYS),
    }
    stage = f"query, width {width}, {name_of(dtype)}"
    with torch.inference_mode():
        seconds = _seconds(works, rounds)
    return _row(stage, FRAME_RAYS, "rays/s", seconds, "float32")


def _frame_row(name: str, dtype: torch.dtype, rounds: int) -> Row:
    settings = screen_network(FRAMES[name])
    x = torch.rand(1, channels_of(settings.features), HEIGHT, WIDTH, device=GPU)
    x = x.contiguous(memory_format=torch.channels_last)
    plain = make_screen_network(settings).for_inference()
    plain = plain.to(GPU, memory_format=torch.channels_last)
    network = plain.in_format(dtype)
    square = torch.rand(PRODUCT, PRODUCT, device=GPU).to(dtype)
    works = {
        "ours": lambda: network(x),
        "plain": lambda: plain(x),
        "products": lambda: square @ square,
    }
    with torch.inference_mode():
        seconds = _seconds(works, rounds)
    seconds["products"] *= total(layers_of(settings), "macs") * WIDTH * HEIGHT / PRODUCT**3
    return _row(f"{name}, {WIDTH} x {HEIGHT}, {name_of(dtype)}", 1, "frames/s", seconds, "float32")


def _seconds(works: Mapping[str, Work], rounds: int, times: int = 1) -> dict[str, float]:
    """Seconds of each work, done so many times in a timed call."""

    def waited_for(work: Work) -> Work:
        def waited() -> None:
            for _ in range(times):
                work()
            torch.cuda.synchronize()

        return waited

    seconds = median_seconds({name: waited_for(work) for name, work in works.items()}, rounds)
    return {name: each / times for name, each in seconds.items()}


def _row(stage: str, amount: int, unit: str, seconds: Mapping[str, float], peer: str) -> Row:
    rate = {name: amount / each for name, each in seconds.items()}
    device = torch.cuda.get_device_name()
    return Row(stage, device, rate["ours"], unit, rate["products"], peer, rate["plain"])
