"""Training steps of the thesis's network, beside the plain step and the matrix products alone.

The plain step is float32 on the whole batch at once, with threads inside each product. The
ceiling is the rate of the layers' matrix products, forward and backward, in our number format.
"""

import torch
from bench_queries import WIDTHS, thesis_network
from measurement import Row, Work, median_seconds, name_of, with_threads

from neural_shadows.networks.compute import choose_dtype
from neural_shadows.networks.object_space.frequency_network import FrequencyNetwork
from neural_shadows.networks.object_space.shadow_network import LabelledBatch
from neural_shadows.training.batches import batch_indices
from neural_shadows.training.training_run import TrainingRun
from neural_shadows.training.workers import Workers

THREADS = 2
BATCH = 1024  # of the desk scale
CPU = torch.device("cpu")


class RandomRays:
    """Rays across the unit sphere with made-up bounds: the rate does not depend on them."""

    count = 1 << 17

    def __init__(self, device: torch.device = CPU):
        generator = torch.Generator().manual_seed(0)
        vectors = torch.randn(2, self.count, 3, generator=generator)
        t_lb = torch.rand(self.count, generator=generator)
        parts = (*vectors / vectors.norm(dim=2, keepdim=True), t_lb, t_lb + 0.1)
        self.parts = LabelledBatch(*(part.to(device) for part in parts))

    def gather(self, indices: torch.Tensor) -> LabelledBatch:
        """A batch of rays and their labels."""
        return LabelledBatch(*(part.index_select(0, indices) for part in self.parts))


def rows(quick: bool) -> list[Row]:
    """Rates at the desk's batch, and the optimisers' part of a step."""
    steps = [_row(width, 7 if quick else 21) for width in WIDTHS]
    return steps + _optimiser_rows(21 if quick else 101)


def new_run(
    width: int,
    batch: int,
    precision: str,
    optimiser: str = "adam",
    device: torch.device = CPU,
) -> TrainingRun:
    """A training of the thesis's network."""
    settings = {"optimiser": optimiser, "learning_rate": 1e-4, "adam_rate": 1e-4, "loss": {}}
    settings |= {"steps": 1, "batch_size": batch, "schedule": "constant"}
    settings |= {"seed": 0, "device": device.type, "precision": precision}
    return TrainingRun(thesis_network(width), settings)


def stepper(run: TrainingRun, rays: RandomRays, pool=None) -> Work:
    """A function that does one step of a training."""
    batch = run.settings["batch_size"]

    def step() -> None:
        indices = batch_indices(run.step, seed=0, batch_size=batch, count=rays.count)
        run.train_step(rays.gather(indices), pool)

    return step


def products(network: FrequencyNetwork, dtype: torch.dtype, rows: int) -> Work:
    """The matrix products of so many samples: forward, and both of the backward pass."""
    layers = [
        (
            torch.randn(rows, weight.shape[1], device=weight.device).to(dtype),
            torch.randn(rows, weight.shape[0], device=weight.device).to(dtype),
            weight.detach().to(dtype),
        )
        for weight in network.layers
    ]

    def multiply() -> None:
        for i, (x, y, weight) in enumerate(layers):
            torch.mm(x, weight.t())
            torch.mm(y.t(), x)
            if i:  # nobody needs the gradient of the encoding
                torch.mm(y, weight)

    return multiply


def _row(width: int, rounds: int) -> Row:
    dtype = choose_dtype("auto", CPU)
    run, whole = (new_run(width, BATCH, precision) for precision in ("auto", "float32"))
    whole.chunk = BATCH
    rays, pool = RandomRays(), Workers(THREADS)
    # Each thread multiplies for itself, as in our step: nothing has to be waited for.
    multiplied = [products(run.network, dtype, run.chunk) for _ in range(BATCH // run.chunk)]
    works = {
        "ours": with_threads(1, stepper(run, rays, pool)),  # each of the pool's threads has one
        "plain": with_threads(THREADS, stepper(whole, rays)),
        "products": with_threads(1, lambda: list(pool.map(lambda work: work(), multiplied))),
    }
    rate = {name: BATCH / seconds for name, seconds in median_seconds(works, rounds).items()}
    return Row(
        f"training, width {width}, {name_of(dtype)}",
        f"cpu x{THREADS}",
        rate["ours"],
        "samples/s",
        ceiling=rate["products"],
        peer="eager float32, whole batch",
        peer_rate=rate["plain"],
    )


def _optimiser_rows(rounds: int) -> list[Row]:
    """What changing the weights takes of a step, whatever its batch, on one thread."""
    torch.set_num_threads(1)
    rate, works = torch.tensor(1e-4), {}
    for name in ("adam", "muon"):
        run = new_run(256, 16, "auto", name)
        stepper(run, RandomRays())()  # which leaves gradients
        optimisers = run.optimisers.values()
        works[name] = lambda optimisers=optimisers: [one.step(rate) for one in optimisers]
    return [
        Row(f"{name}'s part of a step, width 256", "cpu x1", 1000 * seconds, "ms")
        for name, seconds in median_seconds(works, rounds).items()
    ]
