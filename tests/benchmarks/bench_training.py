"""Training steps of the thesis's network, beside the plain step and the matrix products alone.

The plain step is float32 on the whole batch at once, with threads inside each product. The
ceiling is the rate of the layers' matrix products, forward and backward, in our number format.
"""

import itertools

import torch
from measurement import Row, median_seconds

from neural_shadows.networks.compute import choose_device, choose_dtype
from neural_shadows.networks.object_space.frequency_network import FrequencyNetwork
from neural_shadows.networks.object_space.shadow_network import LabelledBatch
from neural_shadows.training.batches import batch_indices
from neural_shadows.training.cuda_graph import WARM_UP, recorded
from neural_shadows.training.training_run import TrainingRun
from neural_shadows.training.training_state import gradient_pool

THREADS = 2
DESK_BATCH, THESIS_BATCH = 1024, 65536
WIDTHS = (256, 128, 64)


class RandomRays:
    """Rays across the unit sphere with made-up bounds: the rate does not depend on them."""

    count = 1 << 17

    def __init__(self, device: torch.device):
        generator = torch.Generator().manual_seed(0)

        def unit() -> torch.Tensor:
            vectors = torch.randn(self.count, 3, generator=generator)
            return (vectors / vectors.norm(dim=1, keepdim=True)).to(device)

        t_lb = torch.rand(self.count, generator=generator).to(device)
        self.parts = LabelledBatch(unit(), unit(), t_lb, t_lb + 0.1)

    def gather(self, indices: torch.Tensor) -> LabelledBatch:
        """A batch of rays and their labels."""
        return LabelledBatch(*(part.index_select(0, indices) for part in self.parts))


def rows(quick: bool) -> list[Row]:
    """Rates at the desk's batch on the CPU, and at the thesis's where there is a GPU."""
    found = [_cpu_row(width, 7 if quick else 21) for width in WIDTHS]
    found += _optimiser_rows(21 if quick else 101)
    if torch.cuda.is_available():
        found += [_cuda_row(width, 20 if quick else 200) for width in WIDTHS]
    return found


def new_run(
    width: int, batch: int, device: torch.device, precision: str, optimiser: str = "adam"
) -> TrainingRun:
    """A training of the thesis's network."""
    network = FrequencyNetwork(frequencies=10, width=width, hidden_layers=8)
    network.initialise(0)
    settings = {"optimiser": optimiser, "learning_rate": 1e-4, "adam_rate": 1e-4, "loss": {}}
    settings |= {"steps": 1, "batch_size": batch, "schedule": "constant"}
    made = {"seed": 0, "device": device.type, "precision": precision}
    return TrainingRun(network, settings | made)


def stepper(run: TrainingRun, rays: RandomRays, pool=None):
    """A function that does one step of a training."""
    batch = run.settings["batch_size"]

    def step() -> None:
        indices = batch_indices(run.step, seed=0, batch_size=batch, count=rays.count)
        run.train_step(rays.gather(indices), pool)

    return step


def _products(network: FrequencyNetwork, dtype: torch.dtype, rows: int):
    """The matrix products of so many samples: forward, and both of the backward pass."""
    device = network.device
    layers = [
        (
            torch.randn(rows, weight.shape[1], device=device).to(dtype),
            torch.randn(rows, weight.shape[0], device=device).to(dtype),
            weight.detach().to(dtype),
        )
        for weight in network.layers
    ]

    def products() -> None:
        for i, (x, y, weight) in enumerate(layers):
            torch.mm(x, weight.t())
            torch.mm(y.t(), x)
            if i:  # nobody needs the gradient of the encoding
                torch.mm(y, weight)

    return products


def _cpu_row(width: int, rounds: int) -> Row:
    cpu = torch.device("cpu")
    dtype = choose_dtype("auto", cpu)
    run, whole = (new_run(width, DESK_BATCH, cpu, name) for name in ("auto", "float32"))
    whole.chunk = DESK_BATCH
    rays, pool = RandomRays(cpu), gradient_pool(THREADS)
    ours, plain = stepper(run, rays, pool), stepper(whole, rays)
    # Each thread multiplies for itself, as in our step: nothing has to be waited for.
    parts = DESK_BATCH // run.chunk
    products = [_products(run.network, dtype, run.chunk) for _ in range(parts)]

    def with_threads(threads: int, work):
        def threaded() -> None:
            torch.set_num_threads(threads)
            work()

        return threaded

    works = {
        "ours": with_threads(1, ours),  # each of the pool's threads has one
        "plain": with_threads(THREADS, plain),
        "products": with_threads(1, lambda: list(pool.map(lambda work: work(), products))),
    }
    seconds = median_seconds(works, rounds)
    return Row(
        f"training, width {width}, {str(dtype).removeprefix('torch.')}",
        f"cpu x{THREADS}",
        DESK_BATCH / seconds["ours"],
        "samples/s",
        ceiling=DESK_BATCH / seconds["products"],
        peer="eager float32, whole batch",
        peer_rate=DESK_BATCH / seconds["plain"],
    )


def _optimiser_rows(rounds: int) -> list[Row]:
    """What changing the weights takes of a step, whatever its batch, on one thread."""
    torch.set_num_threads(1)
    cpu = torch.device("cpu")
    rate = torch.tensor(1e-4)
    works = {}
    for name in ("adam", "muon"):
        run = new_run(256, 16, cpu, "auto", name)
        stepper(run, RandomRays(cpu))()  # which leaves gradients
        optimisers = run.optimisers.values()
        works[name] = lambda optimisers=optimisers: [one.step(rate) for one in optimisers]
    seconds = median_seconds(works, rounds)
    return [
        Row(f"{name}'s part of a step, width 256", "cpu x1", 1000 * seconds[name], "ms")
        for name in works
    ]


def _cuda_row(width: int, rounds: int) -> Row:
    cuda = choose_device("cuda")
    dtype = choose_dtype("auto", cuda)
    rays = RandomRays(cuda)

    run, exact = (new_run(width, THESIS_BATCH, cuda, name) for name in ("auto", "float32"))
    ours, plain = recorded(stepper(run, rays)), stepper(exact, rays)
    products = _products(run.network, dtype, THESIS_BATCH)
    for _ in range(WARM_UP + 1):
        ours()

    def repeated(work):
        def several() -> None:
            for _ in itertools.repeat(None, 20):
                work()
            torch.cuda.synchronize()

        return several

    works = {"ours": ours, "plain": plain, "products": products}
    seconds = median_seconds({name: repeated(work) for name, work in works.items()}, rounds)
    rate = {name: 20 * THESIS_BATCH / value for name, value in seconds.items()}
    return Row(
        f"training, width {width}, {str(dtype).removeprefix('torch.')}",
        torch.cuda.get_device_name(),
        rate["ours"],
        "samples/s",
        ceiling=rate["products"],
        peer="eager float32",
        peer_rate=rate["plain"],
    )
