"""Stage: train a screen-space network on a frame set [Datta et al. 2022, 3.3].

Resumable and reproducible from the seed.
"""

import hashlib
import json
import time
from collections.abc import Callable, Sequence
from functools import partial
from itertools import count
from pathlib import Path
from typing import Any

import torch

from neural_shadows.errors import InputError
from neural_shadows.files.whole_files import sha256_of, write_json, write_text
from neural_shadows.frames.feature_names import TRACED, buffers_of
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
    Image,
    mse_by_radius,
    network_predictor,
    null_errors,
    spread_images,
)
from neural_shadows.training.settings.frames import ScreenTraining
from neural_shadows.training.steps import train_to_end
from neural_shadows.training.training_data import describe_data
from neural_shadows.training.workers import Workers

# Validations in a training, the last at its end, all on the same images: at most these, as 96 of
# 256² take four seconds of two slow cores. The default sets have fewer.
VALIDATIONS = 10
IMAGES = 96


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
    run_cores: int = 0,
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
            `samples_per_second`, `final_loss`, `died_at_step`; `perceptual` (`none` for L1 alone),
            `perceptual_factor`; `data`, see `describe_data`; by `radii` squared errors on at most
            `IMAGES` images, evenly spread over scenes and lights, the same at each step:
            `validations` by step, the last of which is `validation_mse`, and `null_mse` of null
            predictors on the same (`no_shadow`, `hard_map`, and the network's own base); `train_mse`
            and `train_null_mse` on as many images of training frames.
        scenes: of the parts. lights: indices of the radii to train for; None for all.
        threads, run_cores: of `Workers`, for the crops of a batch; the weights do not depend on them.

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
    settings = training.model_dump() | {"perceptual": {"net": net}, "lights": lights} | platform
    header = {
        "name": experiment,
        "network": network.model_dump(),
        "training": settings,
        "features": list(model.features),
        **_describe_frames(frames, model.features),
        "scenes": list(scenes),
        "perceptual": net,
    }
    loss = ScreenLoss(training.alpha, training.perturbation, perceptual)
    run = ScreenRun(model, settings, frames, loss)
    identity = {**header, "data": _digest([*train, *validation, *([trunk] if trunk else [])])}
    code = (STAGES / "train_on_frames.py", form_module(network.form))
    checkpoint = checkpoint_folder(weights, identity, code)
    with Workers(threads, run_cores, training.crops) as workers:
        if perceptual is not None:
            # From the initial weights, whatever step the run continues at.
            loss.factor = loss.factor_for(run.first_terms(workers))
        if (checkpoint / STATE).exists():
            run.restore(checkpoint / STATE)
        compute = workers.map if torch_device.type == "cpu" else map
        images = spread_images(held_out, IMAGES)
        validate = partial(_validate, run, held_out, images, compute)

        def validate_at(step: int) -> None:
            if (
                VALIDATIONS * step // training.steps
                > VALIDATIONS * _validated(run) // training.steps
            ):
                validate()

        numbers = count(int(run.step))

        def advance() -> None:
            run.train_step(next(numbers), workers)

        train_to_end(run, advance, experiment, checkpoint, started, "pixels", validate_at)
        if not run.validations or _validated(run) < int(run.step):
            validate()  # after a divergence
        seen = spread_images(frames, len(images))
        errors = {
            "validation_mse": run.validations[-1]["mse"],
            "null_mse": null_errors(held_out, images, compute),
            "train_mse": mse_by_radius(frames, network_predictor(run, frames), seen, compute),
            "train_null_mse": null_errors(frames, seen, compute),
        }

    save_screen_network(weights, model, header)
    write_text(loss_csv, run.curve_csv())
    result = {"parameters": sum(weight.numel() for weight in run.weights.values()), **run.outcome()}
    result |= {"died_at_step": run.died_at_step, "validations": run.validations, **errors}
    result |= {"perceptual_factor": loss.factor if perceptual is not None else None}
    result |= {"data": describe_data(train, validation)}
    write_json(training_json, {**header, **result, **describe_origin(), "threads": workers.most})


def _describe_frames(frames: ScreenFrames, features: Sequence[str]) -> dict[str, Any]:
    """What a network must know of its frames: lights, and rays if it reads any."""
    about = frames.about
    described = {
        "radii": about.get("given_radii", about["radii"]),
        "radius_unit": about.get("radius_unit", "metres"),
        "light": about.get("light"),
    }
    if {*TRACED} & {*buffers_of(features)}:
        described["rays"] = about["rays"]
    return described


def _validate(
    run: ScreenRun, frames: ScreenFrames, images: Sequence[Image], compute: Callable
) -> None:
    """Add the present errors on images of validation to the run's."""
    mse = mse_by_radius(frames, network_predictor(run, frames), images, compute)
    # In alphabetical order, as a checkpoint restores them.
    run.validations.append({"mse": mse, "step": int(run.step)})


def _validated(run: ScreenRun) -> int:
    """The step of the last validation; 0 before the first."""
    return run.validations[-1]["step"] if run.validations else 0


def _check_perturbed(frames: ScreenFrames, train: Sequence[Path], training: ScreenTraining) -> None:
    if training.perturbation > 0 and frames.twins == 0:
        raise InputError(
            f"{train[0].parent}: no perturbed frames for `perturbation`. Give the frame set "
            "`twins: {count: 3}`, or set `perturbation: 0`."
        )


def _digest(files: Sequence[Path]) -> str:
    """Digest of the data's descriptions, and of sizes and times of the arrays beside them.

    A user may write arrays anew below the same description. Gigabytes are not read for it.
    """
    arrays = [array for path in files for array in sorted(path.parent.glob(f"{path.stem}.*.npy"))]
    states = [(path.name, path.stat().st_size, path.stat().st_mtime_ns) for path in arrays]
    described = [sha256_of(path) for path in files]
    return hashlib.sha256(json.dumps([described, states]).encode()).hexdigest()


if "snakemake" in globals():
    run_stage(snakemake, train_on_frames)
