"""Training of a shadow network on a ray set: resumable, and reproducible from its seed."""

import hashlib
import json
import math
import time
from pathlib import Path
from typing import Any

import torch
from torch import Tensor

from neural_shadows.errors import InputError
from neural_shadows.files.whole_files import write_json, write_text
from neural_shadows.networks.compute import choose_device, choose_dtype
from neural_shadows.networks.kind_module import kind_module
from neural_shadows.networks.kinds import make_network
from neural_shadows.networks.object_space.dead_zone_loss import DeadZone
from neural_shadows.networks.object_space.shadow_network import ShadowNetwork
from neural_shadows.networks.weight_file import save_network
from neural_shadows.running.hardware import describe_machine
from neural_shadows.running.module_graph import modules_of
from neural_shadows.running.progress import progress_bar
from neural_shadows.training.batches import (
    BatchSource,
    DeviceRays,
    LabelledRays,
    batch_indices,
    batch_source,
)
from neural_shadows.training.cuda_graph import recorded
from neural_shadows.training.training_run import (
    TrainingRun,
    chunk_size,
    gradient_pool,
    learning_rate_at,
)

# Points of the loss curve, each the mean loss since the point before.
CURVE_POINTS = 500


def state_digest(description: dict) -> str:
    """A name for a run's saved state: a digest of its settings, its data and the code.

    Changed settings, rays or training code thereby start anew and never resume from a
    state that they did not make.
    """
    digest = hashlib.sha256(json.dumps(description, sort_keys=True).encode())
    for module in (Path(__file__), kind_module(description["network"]["encoding"])):
        for path in (module, *modules_of(module)):
            digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def may_be_recorded(network: ShadowNetwork, device: torch.device, source: BatchSource) -> bool:
    """Whether a GPU can repeat a step on its own, with the samples that it has."""
    return network.recordable and device.type == "cuda" and isinstance(source, DeviceRays)


def check_alive(name: str, step: int, loss: float, spread: float) -> None:
    """Stop a run that can learn nothing any more.

    Raises:
        InputError: the loss is not finite, or all predictions are the same.
    """
    problem = None
    if not math.isfinite(loss):
        problem = f"the loss is {loss}"
    elif not spread > 0:
        problem = "the network answers the same for every ray (its output died)"
    if problem:
        raise InputError(
            f"training {name}: {problem} at step {step}; lower its `learning_rate` in the "
            "config, or change the `seed`"
        )


def train(
    rays: LabelledRays,
    weights: Path,
    loss_csv: Path,
    record_json: Path,
    *,
    name: str,
    network: dict[str, Any],
    steps: int,
    batch_size: int,
    learning_rate: float,
    schedule: str,
    loss: dict[str, float],
    seed: int,
    mesh_ply: Path | None,
    data: dict[str, Any],
    state_folder: Path,
    state_interval_s: float = 30.0,
    device: str = "auto",
    precision: str = "auto",
    threads: int = 1,
) -> None:
    """Train one network with Adam on its loss, the thesis's on the dead-zone loss [3.5, 4.1].

    Writes the weights, the loss curve and a record of the run (seconds, rate, machine). A
    run that was killed continues from its last saved state when it is called again with the
    same arguments, and on a CPU ends in the same weights as an undisturbed one (a GPU adds the
    gradients of grids in any order).

    Args:
        rays: labelled rays.
        weights, loss_csv, record_json: files to write.
        name: of the experiment, for messages.
        network: what `make_network` makes it from.
        schedule: `constant` or `cosine`.
        loss: weights of `DeadZone`.
        mesh_ply: prepared mesh of the object, for a network that needs it; None for others.
        data: description of the rays (their digests and seeds); goes into the weights' header
            and into the name of the saved state.
        state_folder: where states of trainings live. If this one saved any, that of its end is
            left there, so that nothing is lost with the files that it writes; see `saved_states`.
        state_interval_s: seconds between saved states. A kill costs at most that and one point
            of the loss curve, 1/500 of the run.
        threads: chunks of a batch computed side by side; the weights do not depend on it.

    Raises:
        InputError: the loss is not finite or the output is constant.
    """
    torch.set_num_threads(1)  # the pool's threads work side by side
    chosen = choose_device(device)
    dtype = choose_dtype(precision, chosen)
    settings = {
        "steps": steps,
        "batch_size": batch_size,
        "learning_rate": learning_rate,
        "schedule": schedule,
        "loss": loss,
        "seed": seed,
        "device": chosen.type,
        "precision": str(dtype).removeprefix("torch."),
    }
    header = {"name": name, "network": network, "training": settings, "data": data}

    started = last_saved = time.monotonic()  # what is laid out before training counts too
    model = make_network(network)
    if mesh_ply is not None:
        model.prepare(mesh_ply)
    model.initialise(seed)
    run = TrainingRun(model, chosen, DeadZone(**loss), seed)
    run_folder = Path(state_folder) / f"{name}-{state_digest(header)}"
    state_file = run_folder / "state.safetensors"
    if state_file.exists():
        run.restore(state_file)

    chunk = chunk_size(batch_size, chosen, model.training_chunk)
    source = batch_source(rays, chosen)
    point_interval = max(1, steps // CURVE_POINTS)
    seconds_before = run.seconds
    total = steps * batch_size
    step = saved_step = int(run.step)
    with (
        progress_bar(total, "samples", f"train {name}", step * batch_size) as bar,
        gradient_pool(threads) as pool,
    ):

        def rate_at(step: Tensor) -> Tensor:
            return learning_rate_at(
                step, steps=steps, learning_rate=learning_rate, schedule=schedule
            )

        def advance() -> None:
            indices = batch_indices(run.step, seed=seed, batch_size=batch_size, count=rays.count)
            # A GPU is given its work by one thread, whose stream can be recorded.
            workers = pool if chosen.type == "cpu" else None
            run.train_step(source.gather(indices), rate_at(run.step), dtype, chunk, workers)

        if may_be_recorded(model, chosen, source):
            advance = recorded(advance)
        while step < steps:
            advance()
            step += 1
            bar.update(batch_size)
            # States are saved at points of the curve only, so that a restored run has no
            # half-summed loss to carry along; and only there a GPU is waited for.
            if step % point_interval == 0 or step == steps:
                first_step = run.curve[-1][0] if run.curve else 0
                mean_loss = run.loss_sum.item() / (step - first_step)
                check_alive(name, step, mean_loss, run.spread.item())
                run.curve.append([step, rate_at(run.step - 1).item(), mean_loss])
                run.loss_sum.zero_()
                bar.set_postfix(loss=f"{mean_loss:.4g}", refresh=False)
                run.seconds = seconds_before + time.monotonic() - started
                if time.monotonic() - last_saved > state_interval_s:
                    run.save(state_file)
                    write_text(run_folder / "loss.csv", run.curve_csv(batch_size))
                    last_saved, saved_step = time.monotonic(), step
    if 0 < saved_step < steps:
        run.save(state_file)

    save_network(weights, model, header)
    write_text(loss_csv, run.curve_csv(batch_size))
    write_json(
        record_json,
        {
            **header,
            "parameters": model.parameter_count(),
            "samples": total,
            "seconds": round(run.seconds, 1),
            "samples_per_second": round(total / run.seconds),
            "final_loss": run.curve[-1][2],
            "machine": describe_machine(),
            "threads": threads,
        },
    )
