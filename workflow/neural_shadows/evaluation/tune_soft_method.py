"""Stage: a soft-shadow method's constants, from validation frames."""

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
    """Find the constants of least mean squared error, by radius.

    One constant after another, the others at their best so far, or in the middle: 6 settings of two
    constants with three values each, instead of all 9.

    Args:
        parts: of validation frames, of all scenes; meshes: see `measured_frames`.
        fields: of `fit_fields`, for a method that needs them.
        constants_json: by radius in the set's order, `constants` and `mse`; with `tried`, and
            `at_end`, the constants whose best value may lie beyond the candidates.

    Raises:
        InputError: a part is damaged.
    """
    take_fields([method], fields)
    tuned = soft_method(method)
    middle = {name: values[len(values) // 2] for name, values in tuned.constants.items()}
    radii = len(FrameSetPart(parts[0]).radii)
    by_radius = [{"constants": middle, "mse": np.inf, "at_end": []} for _ in range(radii)]
    for name, values in tuned.constants.items():
        tried = [[best["constants"] | {name: value} for value in values] for best in by_radius]
        errors = _errors(tuned, tried, parts, meshes, f"tune {name} of {method}")
        for best, settings, mse in zip(by_radius, tried, errors):
            least = int(mse.argmin())
            best |= {"constants": settings[least], "mse": mse[least]}
            if _at_end(values, mse, least):
                best["at_end"] = [*best["at_end"], name]
    tried = {name: list(values) for name, values in tuned.constants.items()}
    chosen = {"method": method, "tried": tried, "radii": by_radius}
    write_json(constants_json, chosen | describe_origin())


def _errors(
    method: SoftMethod,
    tried: Sequence[Sequence[Constants]],
    parts: Sequence[Path],
    meshes: Sequence[Path],
    title: str,
) -> np.ndarray:
    """Mean squared error off the geometry's edges, (radii, settings).

    Args:
        tried: the settings of each radius, equally many.
    """
    squares, pixels = np.zeros((len(tried), len(tried[0]))), 0
    with progress_bar(sum(len(FrameSetPart(path)) for path in parts), "frames", title) as bar:
        for frame in measured_frames(parts, meshes):
            target, mask = frame.target, frame.off_edges
            if mask is None:
                mask = frame.valid
            pixels += mask.sum()
            by_constants: dict[str, np.ndarray] = {}  # of a method independent of the radius
            for k, settings in enumerate(tried):
                for number, constants in enumerate(settings):
                    image = by_constants.get(str(constants))
                    if image is None:
                        image = frame.answered(method, frame.part.radii[k], constants)
                    if not method.of_radius:
                        by_constants[str(constants)] = image
                    squares[k, number] += np.square(image - target[k])[mask].sum()
            bar.update()
    return squares / pixels


def _at_end(values: Sequence[float], errors: np.ndarray, best: int) -> bool:
    """Check for a best value at an end of the search.

    If its neighbour is worse; a bound of its own, as 0 is, is no end.
    """
    if not values[best] or best not in (0, len(values) - 1):
        return False
    return bool(errors[1 if best == 0 else -2] > errors[best])


if "snakemake" in globals():
    run_stage(snakemake, tune_soft_method)
