"""The stage that chooses a soft-shadow method's constants, on validation frames alone."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from neural_shadows.evaluation.measured_frames import measured_frames
from neural_shadows.evaluation.soft_method import Constants, SoftMethod
from neural_shadows.evaluation.soft_registry import soft_method, take_fields
from neural_shadows.files.whole_files import write_json
from neural_shadows.frames.frame_set import FrameSetPart
from neural_shadows.running.origin import describe_origin
from neural_shadows.running.progress import progress_bar
from neural_shadows.running.stage import run_stage


def tune_soft_method(
    parts: list[Path],
    meshes: list[Path],
    constants_json: Path,
    *,
    fields: list[Path] = (),
    method: str,
) -> None:
    """Find the constants of least mean squared error for each radius of a frame set.

    One constant after another, the others as they were found, or the middle of what is tried: 6
    settings of two constants with three values each, where all are 9.

    Args:
        parts: of validation frames, of all scenes; meshes: see `measured_frames`.
        fields: what `fit_fields` wrote, for a method that asks them.
        constants_json: by radius in the set's order, `constants` and `mse`; with `tried`, and
            `at_end`, the constants of which a better value may lie beyond those that were tried.

    Raises:
        InputError: a part is damaged.
    """
    take_fields([method], fields)
    asked = soft_method(method)
    middle = {name: values[len(values) // 2] for name, values in asked.constants.items()}
    radii = len(FrameSetPart(parts[0]).radii)
    found = [{"constants": middle, "mse": np.inf, "at_end": []} for _ in range(radii)]
    for name, values in asked.constants.items():
        tried = [[one["constants"] | {name: value} for value in values] for one in found]
        errors = _errors(asked, tried, parts, meshes, f"tune {name} of {method}")
        for one, settings, each in zip(found, tried, errors):
            best = int(each.argmin())
            one |= {"constants": settings[best], "mse": each[best]}
            if _at_end(values, each, best):
                one["at_end"] = [*one["at_end"], name]
    tried = {name: list(values) for name, values in asked.constants.items()}
    chosen = {"method": method, "tried": tried, "radii": found}
    write_json(constants_json, chosen | describe_origin())


def _errors(
    method: SoftMethod,
    tried: Sequence[Sequence[Constants]],
    parts: Sequence[Path],
    meshes: Sequence[Path],
    title: str,
) -> np.ndarray:
    """Mean squared error off the geometry's edges, (radii, settings): what shadows are judged by.

    Args:
        tried: the settings of each radius, as many for each.
    """
    squares, pixels = np.zeros((len(tried), len(tried[0]))), 0
    with progress_bar(sum(len(FrameSetPart(path)) for path in parts), "frames", title) as bar:
        for frame in measured_frames(parts, meshes):
            target, measured = frame.target, frame.off_edges
            if measured is None:
                measured = frame.valid
            pixels += measured.sum()
            answers: dict[str, np.ndarray] = {}  # of a method that does not ask for the radius
            for k, settings in enumerate(tried):
                for number, constants in enumerate(settings):
                    answer = answers.get(str(constants))
                    if answer is None:
                        answer = frame.answered(method, frame.part.radii[k], constants)
                    if not method.of_radius:
                        answers[str(constants)] = answer
                    squares[k, number] += np.square(answer - target[k])[measured].sum()
            bar.update()
    return squares / pixels


def _at_end(values: Sequence[float], errors: np.ndarray, best: int) -> bool:
    """Whether the best value is the first or last that was tried, and no bound of its own as 0 is,
    if the one next to it is worse.
    """
    if not values[best] or best not in (0, len(values) - 1):
        return False
    return bool(errors[1 if best == 0 else -2] > errors[best])


if "snakemake" in globals():
    run_stage(snakemake, tune_soft_method)
