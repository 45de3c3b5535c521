"""Stage: train a screen-space network on a frame set [Datta et al. 2022, 3.3].

Resumable and reproducible from the seed.
"""

import hashlib
import json
import time
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path

import torch

from neural_shadows.errors import InputError
from neural_shadows.files.whole_files import sha256_of, write_json, write_text
from neural_shadows.networks.compute import choose_device, choose_dtype
from neural_shadows.networks.kind_module import form_module
from neural_shadows.networks.screen_space.screen_networks import (
    make_screen_network,
    save_screen_network,
)
from neural_shadows.networks.settings.networks import ScreenNetwork
from neural_shadows.running.origin import describe_origin
from neural_shadows.running.stage import run_stage
from neural_shadows.training.checkpoints import STAGES, STATE, checkpoint_folder
from neural_shadows.training.perceptual import Perceptual
from neural_shadows.training.screen_batches import ScreenFrames
from neural_shadows.training.screen_loss import ScreenLoss
from neural_shadows.training.screen_run import ScreenRun
from neural_shadows.training.screen_validation import (
    mse_by_radius,
    network_predictor,
    null_predictors,
)
from neural_shadows.training.settings.frames import ScreenTraining
from neural_shadows.training.steps import curve_points, train_to_end
from neural_shadows.training.training_state import gradient_pool

# Validations in a training, the last at its end. Before that only each third frame: all 60 pictures
# of 12 frames take as long as ten steps.
VALIDATIONS = 10
EVERY = 3


def train_on_frames(
    *,
    train: list[Path],
    validation: list[Path],
    trunk: Path | None,
    weights: Path,
    loss_csv: Path,
    training_json: Path,
    network: ScreenNetwork,
    training: ScreenTraining,
    scenes: Sequence[str],
    lights: list[int] | None,
    seed: int,
    experiment: str,
    device: str = "auto",
    precision: str = "auto",
    threads: int = 1,
) -> None:
    """Train a network on crops, for all radii at once.

    A killed run, called again with the same arguments, continues from its checkpoint, and on a CPU
    ends in the same weights as an uninterrupted one. A final checkpoint stays, see
    `checkpoints.remove_finished`.

    Args:
        train, validation: JSON files of the parts of a frame set.
        trunk: weights file of the perceptual distance's backbone; None for L1 alone.
        weights: in a folder of the experiment's, with `checkpoints` beside it.
        training_json: for the settings and their results: `samples` (pixels), `seconds`,
            `samples_per_second`, `final_loss`, `died_at_step`; `radii` and by them `train_mse` of
            as many training frames as validation has, `validation_mse`, `null_mse` of null
            predictors (`no_shadow`, `hard_map`, and the network's own base); `validations` on the
            way; `perceptual` (`none` for L1 alone), `perceptual_factor`.
        scenes: of the parts. lights: indices of the radii to train for; None for all.
        threads: crops of a batch computed side by side; the weights do not depend on it.

    Raises:
        InputError: a missing or damaged file, NaN, or no perturbed frames for `perturbation`.
    """
    torch.set_num_threads(1)  # the pool's threads work side by side
    started = time.monotonic()
    torch_device = choose_device(device)
    dtype = choose_dtype(precision, torch_device)
    model = make_screen_network(network)
    model.initialise(seed)
    frames, held_out = (ScreenFrames(paths, model.features) for paths in (train, validation))
    model.normalise(frames.ranges)
    _check_perturbed(frames, train, training)
    net = "none" if trunk is None else training.perceptual.net
    perceptual = None if trunk is None else Perceptual(net, trunk, torch_device, dtype)
    dtype_name = str(dtype).removeprefix("torch.")
    platform = {"seed": seed, "device": torch_device.type, "precision": dtype_name}
    header = {
        "name": experiment,
        "network": network.model_dump(),
        "training": {
            **training.model_dump(),
            "perceptual": {"net": net},
            "lights": lights,
            **platform,
        },
        "features": list(model.features),
        "radii": frames.about.get("given_radii", frames.about["radii"]),
        "radius_unit": frames.about.get("radius_unit", "metres"),
        "light": frames.about.get("light"),
        "scenes": list(scenes),
        "perceptual": net,
    }
    loss = ScreenLoss(training.alpha, training.perturbation, perceptual)
    run = ScreenRun(model, header["training"], frames, loss)
    identity = {**header, "data": _digest([*train, *validation, *([trunk] if trunk else [])])}
    code = (STAGES / "train_on_frames.py", form_module(network.form))
    checkpoint = checkpoint_folder(weights, identity, code)
    with gradient_pool(threads) as pool:
        if perceptual is not None:
            # From the initial weights, whatever step the run continues at.
            loss.factor = loss.factor_for(run.first_terms(pool))
        if (checkpoint / STATE).exists():
            run.restore(checkpoint / STATE)
        points = partial(_points, run, held_out, pool)
        train_to_end(run, points, experiment, checkpoint, started, "pixels")
        compute = pool.map if torch_device.type == "cpu" else map
        validation_mse = mse_by_radius(held_out, network_predictor(run, held_out), compute)
        nulls = null_predictors(held_out).items()
        null_mse = {name: mse_by_radius(held_out, null, compute) for name, null in nulls}
        every = -(-len(frames) // len(held_out))  # as many frames, evenly spread
        train_mse = mse_by_radius(frames, network_predictor(run, frames), compute, every)

    save_screen_network(weights, model, header)
    write_text(loss_csv, run.curve_csv())
    errors = {"train_mse": train_mse, "validation_mse": validation_mse, "null_mse": null_mse}
    result = {"parameters": sum(weight.numel() for weight in run.weights.values()), **run.outcome()}
    result |= {"died_at_step": run.died_at_step, "validations": run.validations, **errors}
    result |= {"perceptual_factor": loss.factor if perceptual is not None else None}
    write_json(training_json, {**header, **result, **describe_origin(), "threads": threads})


def _check_perturbed(frames: ScreenFrames, train: Sequence[Path], training: ScreenTraining) -> None:
    if training.perturbation > 0 and frames.twins == 0:
        raise InputError(
            f"{train[0].parent}: no perturbed frames for `perturbation`. Give the frame set "
            "`twins: {count: 3}`, or set `perturbation: 0`."
        )


def _digest(files: Sequence[Path]) -> str:
    """Digest of the data's descriptions; the arrays beside them follow from these."""
    return hashlib.sha256(json.dumps([sha256_of(path) for path in files]).encode()).hexdigest()


def _points(
    run: ScreenRun, held_out: ScreenFrames, pool, after_step: Callable[[int], object]
) -> Iterator[int]:
    """Do the remaining steps, with validations on the way."""
    number, steps = int(run.step), run.settings["steps"]
    compute = pool.map if run.device.type == "cpu" else map

    def advance() -> None:
        nonlocal number
        run.train_step(number, pool)
        number += 1

    before = number
    for step in curve_points(run, advance, after_step):
        if VALIDATIONS * step // steps > VALIDATIONS * before // steps and step < steps:
            mse = mse_by_radius(held_out, network_predictor(run, held_out), compute, EVERY)
            # In alphabetical order, as a checkpoint restores them.
            run.validations.append({"mse": mse, "step": step})
        before = step
        yield step


if "snakemake" in globals():
    run_stage(snakemake, train_on_frames)
