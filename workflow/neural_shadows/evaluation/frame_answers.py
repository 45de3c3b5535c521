"""A method's visibility of a frame by radius, and its errors."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np

from neural_shadows.evaluation.measured_frames import MeasuredFrame
from neural_shadows.evaluation.soft_method import Constants, SoftMethod
from neural_shadows.files.whole_files import read_json
from neural_shadows.metrics.penumbra_width import penumbra_width
from neural_shadows.metrics.visibility_error import visibility_errors


def constants_of(path: Path | None, radii: int) -> list[Constants]:
    """Constants by radius, of `tune_soft_method`; empty without a path."""
    return [each["constants"] for each in read_json(path)["radii"]] if path else [{}] * radii


def all_radii(
    measured: MeasuredFrame, method: SoftMethod, constants: Sequence[Constants]
) -> Iterator[np.ndarray]:
    """The method's image of each radius, evaluated once for equal ones."""
    for k, radius in enumerate(measured.part.radii):
        if method.changes_at(constants, k):
            image = measured.answered(method, radius, constants[k])
        yield image


def errors_of(
    measured: MeasuredFrame, visibility: np.ndarray, k: int, images: Mapping[str, Callable]
) -> dict[str, float]:
    """Metrics of one image. Image metrics see the target at invalid pixels."""
    target, valid = measured.target, measured.valid
    image = np.where(valid, visibility, target[k])
    hard = target[0] if measured.part.radii[0] == 0 else None
    return {
        **visibility_errors(visibility, target[k], valid, hard, measured.off_edges),
        **_widths({"": visibility, "_reference": target[k]}, valid, hard),
        **{name: metric(image, target[k]) for name, metric in images.items()},
    }


def _widths(
    images: Mapping[str, np.ndarray], valid: np.ndarray, hard: np.ndarray | None
) -> dict[str, float]:
    """Mean penumbra widths in pixels; empty without hard shadows."""
    if hard is None:
        return {}
    return {f"width{name}": penumbra_width(image, valid, hard) for name, image in images.items()}
