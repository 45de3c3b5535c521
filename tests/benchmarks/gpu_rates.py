"""What a GPU does in a second: training steps, recorded and plain, and queries."""

import itertools

import pandas as pd
import torch
from bench_training import RandomRays, new_run, stepper
from gpu_checks import FIELD
from measurement import Row, median_seconds, table

from neural_shadows.networks.kinds import make_network
from neural_shadows.training.cuda_graph import WARM_UP, recorded

WIDTHS = (256, 128, 64)
PRECISIONS = ("bfloat16", "float16", "float32")
BATCH = 65_536  # the thesis's [4.1]
QUERY = 1 << 20  # rays, a frame of 1200 × 800 and a little more
REPEATS = 10  # works between two waits for the GPU
ROUNDS = 5


def rates(device: torch.device, name: str, mesh_ply) -> pd.DataFrame:
    """A row for each work, see `measurement.table`; `ratio` is recorded over plain steps.

    Args:
        name: of the device, for the table.
        mesh_ply: a prepared mesh, by which a field is laid out.
    """
    kinds = [(width, precision, "adam") for width in WIDTHS for precision in PRECISIONS]
    kinds.append((WIDTHS[0], PRECISIONS[0], "muon"))
    rows = [_training_row(device, name, *kind) for kind in kinds]
    rows += [_query_row(device, name, width, one) for width in WIDTHS for one in PRECISIONS]
    return table([*rows, _field_row(device, name, mesh_ply)])


def _repeated(device: torch.device, work):
    def several() -> None:
        for _ in itertools.repeat(None, REPEATS):
            work()
        if device.type == "cuda":
            torch.cuda.synchronize()

    return several


def _training_row(device, name: str, width: int, precision: str, optimiser: str) -> Row:
    rays = RandomRays(device)
    runs = [new_run(width, BATCH, device, precision, optimiser) for _ in range(2)]
    plain, replayed = stepper(runs[0], rays), recorded(stepper(runs[1], rays))
    for _ in range(WARM_UP + 1):
        replayed()
    works = {"plain": _repeated(device, plain), "recorded": _repeated(device, replayed)}
    seconds = median_seconds(works, ROUNDS)
    return Row(
        f"training, width {width}, {precision}, {optimiser}",
        name,
        REPEATS * BATCH / seconds["recorded"],
        "samples/s",
        peer="plain step",
        peer_rate=REPEATS * BATCH / seconds["plain"],
    )


def _query_row(device, name: str, width: int, precision: str) -> Row:
    network = new_run(width, 16, device, precision).network
    rate = _query_rate(device, network, getattr(torch, precision))
    return Row(f"query, width {width}, {precision}", name, rate, "rays/s")


def _field_row(device, name: str, mesh_ply) -> Row:
    """Of a field without a surface, whose rays go all the way: on a GPU all do."""
    network = make_network(FIELD)
    network.prepare(mesh_ply)
    network.initialise(0)
    rate = _query_rate(device, network.to(device), torch.float32, QUERY // 8)
    return Row(f"query, occupancy field of {FIELD['resolution']}³", name, rate, "rays/s")


def _query_rate(device, network, dtype: torch.dtype, count: int = QUERY) -> float:
    generator = torch.Generator().manual_seed(0)
    origins = torch.nn.functional.normalize(torch.randn(count, 3, generator=generator)).to(device)
    d = torch.tensor([0.0, -1.0, 0.0], device=device)
    works = {"query": _repeated(device, lambda: network.depths(origins, d, dtype))}
    return REPEATS * count / median_seconds(works, ROUNDS)["query"]
