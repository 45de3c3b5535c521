"""A method's flicker over a sequence of frames."""

from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import repeat, tee
from typing import Any

import numpy as np

from neural_shadows.denoising import taa
from neural_shadows.evaluation.answers import flicker_name
from neural_shadows.evaluation.measured_frames import MeasuredFrame
from neural_shadows.evaluation.method import Constants, Method, visibility
from neural_shadows.evaluation.sequences import Step, answer_sequence, steps_of
from neural_shadows.metrics.kinds.sequences import SHOWN
from neural_shadows.metrics.registry import measure
from neural_shadows.rendering.reprojection import looked_up

EXACT = "_reference"


def flicker(
    frames: Iterable[MeasuredFrame],
    method: Method,
    constants: Sequence[Constants],
    with_history: Sequence[Constants],
    advance: Callable[[], Any],
) -> tuple[dict[str, str | int], dict[str, float], dict[str, np.ndarray]]:
    """Instability over a sequence, of the middle radius.

    Of what is `SHOWN` of the method, by one frame of TAA as Datta et al. 2022 (4) compare with, and of the exact
    shadow; with squared errors of images and of changes, also off the geometry's edges.

    Args:
        constants: by radius, for single frames; with_history: for the method's own, if it has one.

    Returns: the columns of the metrics, the metrics by name, and mean changes of each pixel,
        (height, width), by name, see `answers`.
    """
    errors, changes, sums = defaultdict(list), defaultdict(list), defaultdict(float)
    shown: dict[str, np.ndarray] = {}
    steps, again = tee(steps_of(frames))
    histories = answer_sequence(again, method, with_history) if method.sequence else repeat(None)
    for step, history in zip(steps, histories):
        alone = _alone(step, method, constants)
        past, before = shown, step.before
        image = alone[-1] if history is None else history[1]
        exact = step.now.target[step.now.middle]
        shown = {"": image, "_single": alone[-1], EXACT: exact}
        if before is None:
            shown |= {"_taa": alone[-1], "_recursive": np.mean(alone, axis=0)}
            advance()
            continue
        accepted, places = step.seen
        pixel, places = step.now.frame.surface.pixel[accepted], places[:, accepted]
        held = looked_up(past["_recursive"], places, taa.ORDER)
        past = {name: looked_up(image_before, places) for name, image_before in past.items()}
        shown["_taa"] = taa.blended(alone[-1], pixel, past["_single"])
        shown["_recursive"] = taa.recursive(alone[-1], pixel, held)
        change = {name: new.ravel()[pixel] - past[name] for name, new in shown.items()}
        for name, each in change.items():
            changes[name].append(each)
        for name in ("", EXACT):
            sums[name] = sums[name] + _spread(np.abs(change[name]), pixel, image.shape)
        for name, value in _squared(step, shown, change, pixel, places).items():
            errors[name].append(value)
        advance()
    now = step.now
    if method.sequence is None:  # its single frames are what it shows
        changes.pop("_single")
        errors = {name: each for name, each in errors.items() if not name.endswith("_single")}
    values = {name: float(np.mean(each)) for name, each in errors.items()}
    for name, each in changes.items():
        changed = measure("of_changes", "soft", each, image.size)
        values |= {f"{metric}{name}": value for metric, value in changed.items()}
    maps = {name: total / len(changes[name]) for name, total in sums.items()}
    path = now.part.frames_json
    named = {flicker_name(path): maps[""], flicker_name(path, True): maps[EXACT]}
    return now.key(now.middle) | {"frame": 0}, values, named


def _alone(step: Step, method: Method, constants: Sequence[Constants]) -> list[np.ndarray]:
    """The method's image of a step's frame without history; of the first after `REST` at rest, if rays differ."""
    now = step.now
    radius, chosen = now.part.radii[now.middle], constants[now.middle]
    if not method.by_rays or method.answer is None:
        return [now.answered(method, radius, chosen)]
    return [
        frame.surface.image(visibility(method, frame, radius, chosen), 1.0)
        for frame in step.frames[-1 - taa.REST :]
    ]


def _spread(values: np.ndarray, pixel: np.ndarray, shape: tuple[int, int]) -> np.ndarray:
    image = np.zeros(shape, np.float32)
    image.ravel()[pixel] = values
    return image


def _squared(
    step: Step,
    shown: Mapping[str, np.ndarray],
    change: Mapping[str, np.ndarray],
    pixel: np.ndarray,
    places: np.ndarray,
) -> dict[str, float]:
    """Mean squared errors of a step's images and of their points' changes.

    Args:
        pixel: (m,), of the points seen before, places: (2, m), where.
    """
    now, before, values = step.now, step.before, {}
    masks = {"": now.valid, "_off_edges": now.off_edges}
    column, row = np.rint(places).astype(int)
    for of, mask in masks.items():
        if mask is None:
            continue
        inside = mask.ravel()[pixel]
        inside &= (before.valid if of == "" else before.off_edges)[row, column]
        for name in SHOWN:
            square = np.square(shown[name] - shown[EXACT])
            values[f"mse_sequence{of}{name}"] = float(square[mask].mean())
            wrong = np.square(change[name] - change[EXACT])[inside]
            values[f"mse_change{of}{name}"] = float(wrong.mean())
    return values
