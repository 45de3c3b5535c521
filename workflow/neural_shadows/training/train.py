"""Stage: train a shadow network on a ray set, resumable and reproducible from its seed [3.5, 4.1].

One that is not trained, such as a decimated mesh, is only built.
"""

import math
import time
from collections.abc import Callable, Iterator, Mapping
from functools import partial
from pathlib import Path
from typing import Any

import torch

from neural_shadows.files.whole_files import read_json, write_json, write_text
from neural_shadows.networks.compute import choose_device, choose_dtype
from neural_shadows.networks.kind_module import kind_module
from neural_shadows.networks.kinds import make_network
from neural_shadows.networks.mesh_surface import is_unfit, with_surface
from neural_shadows.networks.object_space.shadow_network import ShadowNetwork
from neural_shadows.networks.weight_file import save_network
from neural_shadows.rays.ray_set import RaySet
from neural_shadows.running.origin import describe_origin
from neural_shadows.running.stage import run_stage
from neural_shadows.settings.records import TrainingSettings
from neural_shadows.training.batches import DeviceRays, batch_indices, batch_source
from neural_shadows.training.checkpoints import STAGES, STATE, checkpoint_folder
from neural_shadows.training.cuda_graph import recorded
from neural_shadows.training.loss_curve import COLUMNS
from neural_shadows.training.no_shadow import no_shadow_loss
from neural_shadows.training.steps import curve_points, train_to_end
from neural_shadows.training.training_run import TrainingRun
from neural_shadows.training.training_state import gradient_pool


def train(
    *,
    mesh_ply: Path | None,
    weights: Path,
    loss_csv: Path,
    training_json: Path,
    network: Mapping[str, Any],
    training: TrainingSettings | None,
    seed: int,
    experiment: str,
    directions_npy: Path | None = None,
    origins: list[Path] = (),
    bounds: list[Path] = (),
    rays_json: Path | None = None,
    mesh_json: Path | None = None,
    device: str = "auto",
    precision: str = "auto",
    threads: int = 1,
) -> None:
    """Train one network on its loss, the thesis's with Adam on the dead-zone loss [3.5, 4.1].

    A run that was killed continues from its checkpoint when it is called again with the same
    arguments, and on a CPU ends in the same weights as an undisturbed one (a GPU adds the
    gradients of grids in any order). A run that saved a checkpoint leaves that of its end: see
    `checkpoints.remove_finished`.

    A run that can learn nothing any more, see `TrainingRun.died_at_step`, ends there with a
    warning. Its weights are written as they are: that a rate kills a network is a result.

    Args:
        mesh_ply, mesh_json: prepared mesh of the object, for a network that needs it, and what
            `prepare_mesh` says of it; None for others.
        weights: in a folder of the experiment's, with `checkpoints` beside it.
        training_json: gets the settings and what came of them: `samples`, `seconds` (laying out
            included), `final_loss`, `died_at_step` and `no_shadow_loss`, what the loss of
            answering no shadow at all would be; and `unfit`, see `is_unfit`.
        network: what `make_network` makes it from; a `surface` of `auto` is the mesh's.
        training: `optimiser` and its rates (`learning_rate`, and muon's `adam_rate`), `steps`,
            `batch_size`, `schedule` (`constant` or `cosine`) and `loss`, the weights of
            `DeadZone`; None for a network that is not trained, which needs no rays.
        directions_npy, origins, bounds, rays_json: of the ray set; its description goes into the
            weights' header.
        precision: of the matrix products, see `choose_dtype`.
        threads: chunks of a batch computed side by side; the weights do not depend on it.

    Raises:
        InputError: a file is missing or damaged, or the optimiser is not for this network.
    """
    torch.set_num_threads(1)  # the pool's threads work side by side
    mesh = {"sheet": False} if mesh_json is None else read_json(mesh_json)
    network = with_surface(network, mesh)
    if mesh_ply is not None:
        # Once for nothing, or the seconds of building would be those of compiling kernels and of
        # loading libraries: of a DAG of 1024³ voxels 8.3 s instead of 0.73.
        make_network(network).prepare(mesh_ply)
    started = time.monotonic()  # what is laid out before training counts too
    header = {"name": experiment, "network": network, "training": None, "data": None}
    if training is not None:
        chosen = choose_device(device)
        dtype = str(choose_dtype(precision, chosen)).removeprefix("torch.")
        made = {"seed": seed, "device": chosen.type, "precision": dtype}
        header |= {"training": {**training, **made}, "data": read_json(rays_json)}
    model = make_network(network)
    if mesh_ply is not None:
        model.prepare(mesh_ply)
    model.initialise(seed)
    if training is not None:
        rays = RaySet(directions_npy, origins, bounds)
        result, curve = _trained(model, header, rays, weights, threads, started)
    else:
        seconds = round(time.monotonic() - started, 1)
        result = {"samples": 0, "seconds": seconds, "samples_per_second": None}
        result |= {"final_loss": None, "no_shadow_loss": None, "died_at_step": None}
        curve = ",".join(COLUMNS) + "\n"

    save_network(weights, model, header)
    write_text(loss_csv, curve)
    about = {"parameters": model.parameter_count(), "unfit": is_unfit(network, mesh), **result}
    write_json(training_json, {**header, **about, **describe_origin(), "threads": threads})


def _trained(
    model: ShadowNetwork,
    header: Mapping[str, Any],
    rays: RaySet,
    weights: Path,
    threads: int,
    started: float,
) -> tuple[dict[str, Any], str]:
    """Train a network; gives what came of it, and the loss curve as CSV."""
    run = TrainingRun(model, header["training"])
    code = (STAGES / "train.py", kind_module(header["network"]["encoding"]))
    checkpoint = checkpoint_folder(weights, header, code)
    if (checkpoint / STATE).exists():
        run.restore(checkpoint / STATE)
    points = partial(ray_points, run, rays, threads)
    train_to_end(run, points, header["name"], checkpoint, started)
    return outcome(run, rays), run.curve_csv()


def outcome(run: TrainingRun, rays: RaySet) -> dict[str, Any]:
    """What came of a training that is at its end, or dead; see `train`'s `training_json`."""
    samples = int(run.step) * run.settings["batch_size"]
    final_loss = run.curve[-1][2]
    return {
        "samples": samples,
        "seconds": round(run.seconds, 1),
        "samples_per_second": round(samples / run.seconds),
        "final_loss": final_loss if math.isfinite(final_loss) else None,
        "no_shadow_loss": no_shadow_loss(rays, run.dead_zone),
        "died_at_step": run.died_at_step,
    }


def ray_points(
    run: TrainingRun, rays: RaySet, threads: int, after_step: Callable[[int], object]
) -> Iterator[int]:
    """Do the steps that are left, see `curve_points`.

    Args:
        after_step: told of the samples of each step.
    """
    batch_size = run.settings["batch_size"]
    source = batch_source(rays, run.device)
    with gradient_pool(threads) as pool:
        # A GPU is given its work by one thread, whose stream can be recorded.
        workers = pool if run.device.type == "cpu" else None

        def advance() -> None:
            indices = batch_indices(
                run.step, seed=run.settings["seed"], batch_size=batch_size, count=rays.count
            )
            run.train_step(source.gather(indices), workers)

        if run.network.recordable and isinstance(source, DeviceRays):
            advance = recorded(advance)
        yield from curve_points(run, advance, after_step)


if "snakemake" in globals():
    run_stage(snakemake, train)
