"""A method's flicker over a sequence of frames."""

from collections import defaultdict
from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np

from neural_shadows.evaluation.answers import flicker_name
from neural_shadows.evaluation.measured_frames import MeasuredFrame
from neural_shadows.evaluation.method import Constants, Method
from neural_shadows.evaluation.sequences import answer_sequence, steps_of
from neural_shadows.metrics.registry import measure
from neural_shadows.rendering.reprojection import looked_up


def flicker(
    frames: Iterable[MeasuredFrame],
    method: Method,
    constants: Sequence[Constants],
    advance: Callable[[], Any],
) -> tuple[dict[str, str | int], dict[str, float], dict[str, np.ndarray]]:
    """Instability over a sequence, of the middle radius.

    Of the method, the exact shadow, and the method's frames each averaged with the one before
    (`_taa`); with squared errors, also off the geometry's edges. One frame of history is what Datta et
    al. 2022 (4) compare with.
    Returns: the columns of the metrics, the metrics by name, and mean changes of each pixel,
        (height, width), by name, see `answers`.
    """
    changes: dict[str, list[np.ndarray]] = {"": [], "_reference": [], "_taa": []}
    errors = defaultdict(list)
    images = answer_sequence(steps_of(frames), method, constants)
    step, last = next(images)
    before, averaged = step.now, last
    sums = {name: np.zeros(last.size, np.float32) for name in changes}
    advance()
    part, k = before.part, before.middle
    key = before.key(k) | {"frame": 0}
    for step, visibility in images:
        now, (accepted, pixels_before) = step.now, step.seen
        pixel, pixels_before = now.frame.surface.pixel[accepted], pixels_before[:, accepted]
        target = now.target[k]
        blended = visibility.copy()
        blended.ravel()[pixel] += (looked_up(last, pixels_before) - blended.ravel()[pixel]) / 2
        for name, old, new in (
            ("", last, visibility),
            ("_reference", before.target[k], target),
            ("_taa", averaged, blended),
        ):
            changes[name].append(new.ravel()[pixel] - looked_up(old, pixels_before))
            sums[name][pixel] += np.abs(changes[name][-1])
        pixels_of = {"": now.valid, "_off_edges": now.off_edges}
        for name, image in (("sequence", visibility), ("taa", blended)):
            square = np.square(image - target)
            for ending, mask in pixels_of.items():
                if mask is not None:
                    errors[f"mse_{name}{ending}"].append(float(square[mask].mean()))
        before, last, averaged = now, visibility, blended
        advance()
    pixels = part.about["width"] * part.about["height"]
    values = {name: float(np.mean(each)) for name, each in errors.items()}
    for name, each in changes.items():
        changed = measure("of_changes", "soft", each, pixels)
        values |= {f"{metric}{name}": value for metric, value in changed.items()}
    count = len(errors["mse_sequence"])
    maps = {name: (total / count).reshape(last.shape) for name, total in sums.items()}
    path = part.frames_json
    named = {flicker_name(path): maps[""], flicker_name(path, True): maps["_reference"]}
    return key, values, named
