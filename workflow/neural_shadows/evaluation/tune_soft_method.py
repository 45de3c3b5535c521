"""The stage that chooses a soft-shadow method's constants, on validation frames alone."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from neural_shadows.evaluation.measured_frames import measured_frames
from neural_shadows.evaluation.soft_methods.registry import soft_method
from neural_shadows.evaluation.soft_methods.soft_method import Constants, SoftMethod
from neural_shadows.files.whole_files import write_json
from neural_shadows.frames.frame_set import FrameSetPart
from neural_shadows.running.progress import progress_bar
from neural_shadows.running.stage import run_stage


def tune_soft_method(
    parts: list[Path], meshes: list[Path], constants_json: Path, *, method: str
) -> None:
    """Find the constants of least mean squared error for each radius of a frame set.

    Args:
        parts: of validation frames, of all scenes; meshes: see `measured_frames`.
        constants_json: by radius in the set's order, `constants` and `mse`; with `tried`, and
            `at_end`, the constants of which a better value may lie beyond those that were tried.

    Raises:
        InputError: a part is damaged.
    """
    asked = soft_method(method)
    settings = asked.settings()
    opened = [FrameSetPart(path) for path in parts]
    radii = len(opened[0].radii)
    squares, pixels = np.zeros((len(settings), radii)), 0
    with progress_bar(sum(map(len, opened)), "frames", f"tune {method}") as bar:
        for frame in measured_frames(parts, meshes):
            valid, target = frame.valid, frame.target
            pixels += valid.sum()
            for row, constants in enumerate(settings):
                for k, radius in enumerate(frame.part.radii):
                    if asked.asked_again([constants] * radii, k):
                        found = frame.answered(asked, radius, constants)
                    squares[row, k] += np.square(found - target[k])[valid].sum()
            bar.update()
    best = squares.argmin(0)
    chosen = [settings[row] for row in best]
    write_json(
        constants_json,
        {
            "method": method,
            "tried": {name: list(values) for name, values in asked.constants.items()},
            "radii": [
                {
                    "constants": one,
                    "mse": squares[row, k] / pixels,
                    "at_end": _at_end(asked, one, dict(zip(map(str, settings), squares[:, k]))),
                }
                for k, (one, row) in enumerate(zip(chosen, best))
            ],
        },
    )


def _at_end(method: SoftMethod, chosen: Constants, errors: Mapping[str, float]) -> list[str]:
    """The constants whose best value is the first or last that was tried, and no bound of its own
    as 0 is, if the one next to it is worse.

    Args:
        errors: of each setting, by its text.
    """
    found = []
    for name, values in method.constants.items():
        ends = {values[0]: values[1], values[-1]: values[-2]}
        value = chosen[name]
        if value and value in ends:
            inside = errors[str({**chosen, name: ends[value]})]
            if inside > errors[str(chosen)]:
                found.append(name)
    return found


if "snakemake" in globals():
    run_stage(snakemake, tune_soft_method)
