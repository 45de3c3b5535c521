"""What a method answers on a frame for each radius, and how far that is from the exact shadow."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np

from neural_shadows.evaluation.measured_frames import MeasuredFrame
from neural_shadows.evaluation.soft_method import Constants, SoftMethod
from neural_shadows.files.whole_files import read_json
from neural_shadows.metrics.penumbra_width import penumbra_width
from neural_shadows.metrics.visibility_error import visibility_errors


def constants_of(path: Path | None, radii: int) -> list[Constants]:
    """By radius, as `tune_soft_method` wrote them; none of a method that has none (no path)."""
    return [one["constants"] for one in read_json(path)["radii"]] if path else [{}] * radii


def all_radii(
    measured: MeasuredFrame, method: SoftMethod, constants: Sequence[Constants]
) -> Iterator[np.ndarray]:
    """The method's picture of each radius; it is asked once where they have the same."""
    for k, radius in enumerate(measured.part.radii):
        if method.changes_at(constants, k):
            found = measured.answered(method, radius, constants[k])
        yield found


def errors_of(
    measured: MeasuredFrame, found: np.ndarray, k: int, images: Mapping[str, Callable]
) -> dict[str, float]:
    """The metrics of one image; those of pictures see the target where a pixel does not count."""
    target, valid = measured.target, measured.valid
    picture = np.where(valid, found, target[k])
    hard = target[0] if measured.part.radii[0] == 0 else None
    return {
        **visibility_errors(found, target[k], valid, hard, measured.off_edges),
        **_widths({"": found, "_reference": target[k]}, valid, hard),
        **{name: metric(picture, target[k]) for name, metric in images.items()},
    }


def _widths(
    images: Mapping[str, np.ndarray], valid: np.ndarray, hard: np.ndarray | None
) -> dict[str, float]:
    """Mean widths of penumbrae in pixels; none where the edges of hard shadows are not known."""
    if hard is None:
        return {}
    return {f"width{name}": penumbra_width(one, valid, hard) for name, one in images.items()}
