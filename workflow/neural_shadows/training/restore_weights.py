"""Stage: take a network's shipped weights in place of a training."""

import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from neural_shadows.errors import InputError
from neural_shadows.files.download import downloaded
from neural_shadows.files.whole_files import sha256_of, whole_file, write_json
from neural_shadows.networks.screen_space.screen_networks import load_screen_network
from neural_shadows.networks.settings.networks import ScreenNetwork, screen_network
from neural_shadows.running.stage import run_stage

# What tables and the model card read of a header, beside the network.
NEEDED = (
    *("name", "training", "features", "radii", "radius_unit", "light", "scenes", "perceptual"),
    *("parameters", "samples", "seconds", "threads", "machine", "commit", "data", "licence"),
    *("validation_mse", "null_mse", "died_at_step"),
)
CURE = "Write the file by `python -m neural_shadows.training.ship_weights results/networks/NAME`"


def restore_weights(
    file: Path | None,
    weights: Path,
    training_json: Path,
    *,
    path: str,
    sha256: str,
    network: ScreenNetwork,
    experiment: str,
) -> None:
    """Copy or download weights that fit an experiment.

    Args:
        file: to copy; None to download `path`.
        weights: a copy, to the byte.
        training_json: the weights' header, as `train_on_frames` writes it, with `shipped`: path and
            SHA-256.
        path: as in the configuration, a file or a URL.

    Raises:
        InputError: no file, another checksum, no network of this pipeline, or one of other settings.
    """
    key = f"experiments.{experiment}"
    with whole_file(weights) as part:
        if file is None:
            cure = (
                f"Try again, or download it by hand and name the file in `{key}.weights.path`, or "
                f"train with `{key}.weights: null`"
            )
            with downloaded(path, sha256, weights.parent, cure) as (own,):
                shutil.copyfile(own, part)
        else:
            _check_digest(file, sha256, f"{key}.weights.sha256")
            shutil.copyfile(file, part)
        header = _fitting_header(part, network, path, key)
    write_json(training_json, {**header, "shipped": {"path": path, "sha256": sha256}})


def _check_digest(file: Path, sha256: str, key: str) -> None:
    if (own := sha256_of(file)) != sha256:
        raise InputError(
            f"{file}: its SHA-256 is {own}, and {key} = {sha256}: cut off, or another file. Take the "
            "file again, or set the key to its own"
        )


def _fitting_header(file: Path, network: ScreenNetwork, path: str, key: str) -> dict[str, Any]:
    """Header of a file of weights, checked against an experiment's network."""
    try:
        _, header = load_screen_network(file)
    except InputError as error:
        reason = " ".join(str(error.__cause__).split())[:200]
        raise InputError(
            f"{path}: no weights of a screen-space network of this pipeline ({reason}). Name others in "
            f"`{key}.weights`"
        ) from error
    check_header(header, path)
    theirs = screen_network(header["network"]).model_dump()
    for name, value in network.model_dump().items():
        if theirs.get(name) != value:
            raise InputError(
                f"{path}: {key}.network: {name} = {value!r}, but these weights have "
                f"{theirs.get(name)!r}. Take their value, or train with `{key}.weights: null`"
            )
    return header


def check_header(header: Mapping[str, Any], path: Path | str, cure: str = CURE) -> None:
    """Check that a header, or a training.json, describes its training."""
    if missing := [key for key in NEEDED if key not in header]:
        raise InputError(f"{path}: has no {', '.join(missing)}. {cure}")


if "snakemake" in globals():
    run_stage(snakemake, restore_weights)
