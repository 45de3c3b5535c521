"""Whether a GPU computes what the CPU does: draws, depths, training steps, recorded steps.

Each check gives its largest error and the error that is allowed: rounding, and no more. One that
fails or cannot be done does not keep the others from being done.
"""

import math
import traceback
from collections.abc import Callable, Iterator
from typing import Any

import torch
from bench_training import RandomRays, new_run
from torch import Tensor

from neural_shadows.networks.compute import is_native
from neural_shadows.networks.kinds import make_network
from neural_shadows.networks.object_space.shadow_network import ShadowNetwork
from neural_shadows.rays.ray_set import RaySet
from neural_shadows.training import cuda_graph
from neural_shadows.training.batches import DeviceRays, batch_indices, batch_source
from neural_shadows.training.training_run import TrainingRun

CPU = torch.device("cpu")
WIDTH = 256
RAYS = 1 << 16  # asked of each network
STEPS = 8  # after those before a recording
FIELD = {"encoding": "occupancy_field", "resolution": 128, "surface": "solid", "stored": "float32"}
FIELD_STEPS = 60  # until it has a surface


def agreement(device: torch.device, rays: RaySet, mesh_ply) -> list[dict[str, Any]]:
    """A row for each check: `check`, `error`, `allowed`, `passed`; or `failure`, a traceback.

    Args:
        rays: of the object; mesh_ply: its prepared mesh, for an occupancy field.
    """
    checks = _checks(device, rays, mesh_ply)
    return [{"check": name} | _done(check, allowed) for name, allowed, check in checks]


def _done(check: Callable[[], float], allowed: float) -> dict[str, Any]:
    try:
        error = check()
    except Exception:
        return {"passed": False, "failure": traceback.format_exc()}
    return {"error": error, "allowed": allowed, "passed": error <= allowed}


def _checks(device, rays, mesh_ply) -> Iterator[tuple[str, float, Callable[[], float]]]:
    """Of each check: what it is, the error that is allowed, and what finds the error."""
    yield "indices of a batch that differ", 0, lambda: _indices(device)
    yield "rays of a batch that differ", 0, lambda: _gathered(device, rays)
    # The phase 2^9 pi x differs by up to 1e-4 where a device rounds otherwise.
    yield "frequency network: depth, in radii", 1e-3, lambda: _depths(device, "float32")
    # Beyond the CPU's own bfloat16, whose products are rounded elsewhere in their sums.
    yield "frequency network in bfloat16: depth", 5e-2, lambda: _depths(device, "bfloat16")
    yield (
        "occupancy field: share of depths more than a tenth of a cell apart",
        1e-3,
        lambda: _field(device, rays, mesh_ply),
    )
    for optimiser in ("adam", "muon"):
        yield (
            f"{STEPS} steps of {optimiser} in float32: weights, over their way",
            0.05,
            lambda optimiser=optimiser: _steps(device, rays, optimiser),
        )
        # In the device's own format, which steps run in; and in the thesis's, with its loss scale,
        # where the device has it.
        own = ["float16"] if is_native(torch.float16, device) else []
        for precision in ("auto", *own):
            yield (
                f"recorded steps of {optimiser} in {precision} beside plain ones: weights, over "
                "their way",
                0.01,
                lambda made=(optimiser, precision): _recorded(device, rays, *made),
            )


def _indices(device: torch.device) -> float:
    drawn = [
        batch_indices(torch.tensor(7, device=one), seed=3, batch_size=4096, count=10**7).cpu()
        for one in (CPU, device)
    ]
    return (drawn[0] != drawn[1]).sum().item()


def _gathered(device: torch.device, rays: RaySet) -> float:
    indices = torch.arange(0, rays.count, max(1, rays.count // 4096))
    ours = batch_source(rays, CPU).gather(indices)
    theirs = DeviceRays(rays, device).gather(indices.to(device))
    return sum((a != b.cpu()).sum().item() for a, b in zip(ours, theirs, strict=True))


def _depths_on(network: ShadowNetwork, device: torch.device, dtype: torch.dtype) -> Tensor:
    rays = RandomRays(CPU).parts
    d = rays.directions[0]
    # Where rays along d enter the sphere: those of its points that d points into.
    origins = rays.origins[rays.origins @ d < 0][:RAYS].to(device)
    return network.to(device).depths(origins, d.to(device), dtype).cpu()


def _depths(device: torch.device, precision: str) -> float:
    # The network alone: the CPU emulates the format where it lacks it, and so knows the answer.
    network, dtype = new_run(WIDTH, 16, CPU, "float32").network, getattr(torch, precision)
    return (_depths_on(network, CPU, dtype) - _depths_on(network, device, dtype)).abs().max().item()


def _field(device: torch.device, rays: RaySet, mesh_ply) -> float:
    """A field trained on the device: the CPU marches through it, and skips what is empty."""
    network = make_network(FIELD)
    network.prepare(mesh_ply)
    network.initialise(0)
    settings = {"optimiser": "adam", "learning_rate": 0.5, "schedule": "cosine", "loss": {}}
    settings |= {"steps": FIELD_STEPS, "batch_size": RAYS, "seed": 0}
    run = TrainingRun(network, settings | {"device": device.type, "precision": "float32"})
    source = batch_source(rays, run.device)
    for _ in range(FIELD_STEPS):
        run.train_step(source.gather(_next_indices(run, rays)))
    theirs = _depths_on(network, device, torch.float32)
    ours = _depths_on(network, CPU, torch.float32)
    cell = 2 / FIELD["resolution"]
    return ((ours - theirs).abs() > cell / 10).float().mean().item()


def _next_indices(run: TrainingRun, rays: RaySet) -> Tensor:
    made = {"seed": run.settings["seed"], "batch_size": run.settings["batch_size"]}
    return batch_indices(run.step, count=rays.count, **made)


def _steps(device: torch.device, rays: RaySet, optimiser: str) -> float:
    runs = [new_run(WIDTH, 1024, one, "float32", optimiser) for one in (CPU, device)]
    for run in runs:
        source = batch_source(rays, run.device)
        for _ in range(STEPS):
            run.train_step(source.gather(_next_indices(run, rays)))
    return _apart(*runs)


def _recorded(device: torch.device, rays: RaySet, optimiser: str, precision: str) -> float:
    runs = [new_run(WIDTH, 1024, device, precision, optimiser) for _ in range(2)]
    source = DeviceRays(rays, device)

    def step(run: TrainingRun) -> None:
        run.train_step(source.gather(_next_indices(run, rays)))

    recorded = cuda_graph.recorded(lambda: step(runs[1]))
    for _ in range(cuda_graph.WARM_UP + STEPS):
        step(runs[0])
        recorded()
    return _apart(*runs)


def _apart(ours: TrainingRun, theirs: TrainingRun) -> float:
    """How far the weights of two runs are apart, over how far they have come, at most.

    Infinitely, where one is not finite.
    """
    if not all(w.isfinite().all() for run in (ours, theirs) for w in run.weights.values()):
        return math.inf
    start = new_run(WIDTH, 16, CPU, "float32").weights
    return max(
        ((a.cpu() - b.cpu()).norm() / (a.cpu() - start[name]).norm()).item()
        for (name, a), b in zip(ours.weights.items(), theirs.weights.values(), strict=True)
    )
