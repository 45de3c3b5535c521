"""Stage: train a shadow network on a ray set, resumable and reproducible from its seed [3.5, 4.1]."""

import math
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import torch

from neural_shadows.errors import InputError
from neural_shadows.files.whole_files import read_json, write_json, write_text
from neural_shadows.networks.compute import choose_device, choose_dtype
from neural_shadows.networks.kinds import make_network
from neural_shadows.networks.weight_file import save_network
from neural_shadows.rays.ray_set import RaySet
from neural_shadows.running.hardware import describe_machine
from neural_shadows.running.progress import progress_bar
from neural_shadows.running.stage import run_stage
from neural_shadows.training.batches import DeviceRays, batch_indices, batch_source
from neural_shadows.training.checkpoints import STATE, checkpoint_folder
from neural_shadows.training.cuda_graph import recorded
from neural_shadows.training.training_run import TrainingRun, gradient_pool

# Points of the loss curve, each the mean loss since the point before.
CURVE_POINTS = 500

# Between checkpoints. A kill costs at most that and one point of the loss curve, 1/500 of the run.
CHECKPOINT_SECONDS = 30.0


def train(
    *,
    directions_npy: Path,
    origins: list[Path],
    bounds: list[Path],
    rays_json: Path,
    mesh_ply: Path | None,
    weights: Path,
    loss_csv: Path,
    training_json: Path,
    network: Mapping[str, Any],
    training: Mapping[str, Any],
    seed: int,
    experiment: str,
    device: str = "auto",
    precision: str = "auto",
    threads: int = 1,
) -> None:
    """Train one network with Adam on its loss, the thesis's on the dead-zone loss [3.5, 4.1].

    A run that was killed continues from its checkpoint when it is called again with the same
    arguments, and on a CPU ends in the same weights as an undisturbed one (a GPU adds the
    gradients of grids in any order). A run that saved a checkpoint leaves that of its end: see
    `checkpoints.remove_finished`.

    Args:
        rays_json: the ray set's description, which goes into the weights' header.
        mesh_ply: prepared mesh of the object, for a network that needs it; None for others.
        weights: in a folder of the experiment's, with `checkpoints` beside it.
        network: what `make_network` makes it from.
        training: `steps`, `batch_size`, `learning_rate`, `schedule` (`constant` or `cosine`) and
            `loss`, the weights of `DeadZone`.
        threads: chunks of a batch computed side by side; the weights do not depend on it.

    Raises:
        InputError: the loss is not finite or the output is constant; or a file is missing or
            damaged.
    """
    torch.set_num_threads(1)  # the pool's threads work side by side
    started = time.monotonic()  # what is laid out before training counts too
    chosen = choose_device(device)
    header = {
        "name": experiment,
        "network": dict(network),
        "training": {
            **training,
            "seed": seed,
            "device": chosen.type,
            "precision": str(choose_dtype(precision, chosen)).removeprefix("torch."),
        },
        "data": read_json(rays_json),
    }
    checkpoint = checkpoint_folder(weights, header)
    model = make_network(network)
    if mesh_ply is not None:
        model.prepare(mesh_ply)
    model.initialise(seed)
    run = TrainingRun(model, header["training"])
    if (checkpoint / STATE).exists():
        run.restore(checkpoint / STATE)
    rays = RaySet(directions_npy, origins, bounds)
    train_to_end(run, rays, experiment, checkpoint, threads, started)

    samples = training["steps"] * training["batch_size"]
    save_network(weights, model, header)
    write_text(loss_csv, run.curve_csv())
    write_json(
        training_json,
        {
            **header,
            "parameters": model.parameter_count(),
            "samples": samples,
            "seconds": round(run.seconds, 1),
            "samples_per_second": round(samples / run.seconds),
            "final_loss": run.curve[-1][2],
            "machine": describe_machine(),
            "threads": threads,
        },
    )


def train_to_end(
    run: TrainingRun, rays: RaySet, name: str, checkpoint: Path, threads: int, started: float
) -> None:
    """Do the steps that are left; the run's seconds count from `started` on the monotonic clock."""
    steps, batch_size = run.settings["steps"], run.settings["batch_size"]
    source = batch_source(rays, run.device)
    point_interval = max(1, steps // CURVE_POINTS)
    seconds_before, last_saved = run.seconds, started
    step = saved_step = int(run.step)
    with (
        progress_bar(steps * batch_size, "samples", f"train {name}", step * batch_size) as bar,
        gradient_pool(threads) as pool,
    ):
        # A GPU is given its work by one thread, whose stream can be recorded.
        workers = pool if run.device.type == "cpu" else None

        def advance() -> None:
            indices = batch_indices(
                run.step, seed=run.settings["seed"], batch_size=batch_size, count=rays.count
            )
            run.train_step(source.gather(indices), workers)

        if run.network.recordable and isinstance(source, DeviceRays):
            advance = recorded(advance)
        while step < steps:
            advance()
            step += 1
            bar.update(batch_size)
            # Checkpoints are written at points of the curve only, so that a restored run has no
            # half-summed loss to carry along; and only there a GPU is waited for.
            if step % point_interval == 0 or step == steps:
                mean_loss = run.add_point()
                check_learning(name, step, mean_loss, run.spread.item())
                bar.set_postfix(loss=f"{mean_loss:.4g}", refresh=False)
                run.seconds = seconds_before + time.monotonic() - started
                if time.monotonic() - last_saved > CHECKPOINT_SECONDS:
                    run.save(checkpoint / STATE)
                    write_text(checkpoint / "loss.csv", run.curve_csv())
                    last_saved, saved_step = time.monotonic(), step
    if 0 < saved_step < steps:
        run.save(checkpoint / STATE)


def check_learning(name: str, step: int, loss: float, spread: float) -> None:
    """Stop a run that can learn nothing any more.

    Raises:
        InputError: the loss is not finite, or all predictions are the same.
    """
    if math.isfinite(loss) and spread > 0:
        return
    problem = "the network answers the same for every ray (its output died)"
    if not math.isfinite(loss):
        problem = f"the loss is {loss}"
    raise InputError(
        f"training {name}: {problem} at step {step}; lower its `learning_rate` in the "
        "config, or change the `seed`"
    )


if "snakemake" in globals():
    run_stage(snakemake, train)
