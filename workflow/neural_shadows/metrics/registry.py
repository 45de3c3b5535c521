"""Metrics by key: each module of `metrics/kinds` is a family of them.

A family has `METRICS`, and the function that measures them, by what it needs:

- `of_images(image, reference)`: a frame and its reference (H, W) in [0, 1]. LPIPS, with a pretrained
  backbone, has `with_model(lpips_onnx, threads)` instead, which returns this function.
- `of_visibility(visibility, target, pixels)`: of a frame's points, with `Pixels`.
- `of_occluders(visibility, target, valid, solids, widths)`: (H, W), see `measure_frames`.
- `of_changes(changes, pixels)`: from frame to frame of a sequence, (n,) of each pair, and the pixels
  of a frame.
- or none: of what trainings or tables compute.

Each returns values by key. None is imported by a statement, but the names of `sequences`: `module_graph` adds all
of them to what imports this module.
"""

from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import BeforeValidator

from neural_shadows.files.whole_files import read_json
from neural_shadows.metrics.metric import Light, Metric
from neural_shadows.settings.base import not_among
from neural_shadows.settings.kinds import kinds

FOLDER = "metrics/kinds"
INPUTS = ("of_images", "of_visibility", "of_occluders", "of_changes", "")
PER_FRAME = INPUTS[:2]  # in all evaluations
OfImages = Callable[[np.ndarray, np.ndarray], Mapping[str, float]]


def inputs_of(family: ModuleType) -> str:
    """The name in `INPUTS` of a family's function."""
    if hasattr(family, "with_model"):
        return "of_images"
    return next(name for name in INPUTS if not name or hasattr(family, name))


@cache
def families(inputs: str) -> list[ModuleType]:
    """The families with a function of `INPUTS`."""
    return [family for family in kinds(FOLDER).values() if inputs_of(family) == inputs]


@cache
def metrics(inputs: tuple[str, ...] = INPUTS) -> dict[str, Metric]:
    """All metrics by key, in the order of `INPUTS` and of their files; or those of some inputs."""
    all_families = [family for name in inputs for family in families(name)]
    return {key: metric for family in all_families for key, metric in family.METRICS.items()}


def frame_metrics(light: Light) -> list[str]:
    """Keys of errors of single frames under such a light."""
    pairs = metrics(PER_FRAME).items()
    return [key for key, metric in pairs if light in metric.lights and metric.better]


def metric_in(light: Light, *others: str) -> Any:
    """Type of a setting: a metric of `frame_metrics`, or another name."""
    names = (*frame_metrics(light), *others)

    def check(name: Any) -> Any:
        if isinstance(name, str) and name not in names:
            raise ValueError(not_among(name, names))
        return name

    return Annotated[Literal[names], BeforeValidator(check)]


def measure(inputs: str, light: Light, *arguments: Any) -> dict[str, float]:
    """Values of all metrics of frames under such a light, by key.

    Args:
        inputs: the name of a function of families; arguments: its.
    """
    return {
        key: value
        for family in families(inputs)
        if _measured(family, light)
        for key, value in getattr(family, inputs)(*arguments).items()
        if light in family.METRICS[key].lights
    }


def image_metrics(
    light: Light, lpips_json: Path | None = None, threads: int = 1, slow: bool = True
) -> OfImages:
    """Function of a frame and its reference, (H, W) in [0, 1], to all image metrics.

    Args:
        lpips_json: of `find_lpips`, its model beside it; LPIPS is left out without it or where it is
            not available.
        threads: of LPIPS. slow: with metrics that are `slow`.
    """
    has_lpips = bool(lpips_json and slow and read_json(lpips_json)["available"])
    functions = []
    for family in families("of_images"):
        if not _measured(family, light, slow):
            continue
        if not hasattr(family, "with_model"):
            functions.append(family.of_images)
        elif has_lpips:
            functions.append(family.with_model(lpips_json.with_suffix(".onnx"), threads))
    return lambda image, reference: {
        key: value for function in functions for key, value in function(image, reference).items()
    }


def _measured(family: ModuleType, light: Light, slow: bool = True) -> bool:
    metrics = family.METRICS.values()
    return any(light in metric.lights and (slow or not metric.slow) for metric in metrics)


def error_of(metric: str, value: np.ndarray) -> np.ndarray:
    """A metric's errors, which fall to 0, of values: see `Metric.to_error`."""
    return metrics()[metric].error(value)


def value_of(metric: str, error: np.ndarray) -> np.ndarray:
    """A metric's values from errors of `error_of`."""
    return metrics()[metric].value(error)
