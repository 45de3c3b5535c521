"""A method's flicker over a sequence of frames."""

from collections import defaultdict
from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np

from neural_shadows.denoising import taa
from neural_shadows.evaluation.answers import flicker_name
from neural_shadows.evaluation.measured_frames import MeasuredFrame
from neural_shadows.evaluation.method import Constants, Method
from neural_shadows.evaluation.sequences import answer_sequence, steps_of
from neural_shadows.metrics.kinds.sequences import SHOWN
from neural_shadows.metrics.registry import measure
from neural_shadows.rendering.reprojection import looked_up


def flicker(
    frames: Iterable[MeasuredFrame],
    method: Method,
    constants: Sequence[Constants],
    advance: Callable[[], Any],
) -> tuple[dict[str, str | int], dict[str, float], dict[str, np.ndarray]]:
    """Instability over a sequence, of the middle radius.

    Of the method, the exact shadow, and the method with temporal anti-aliasing, by one frame (`_taa`), as
    Datta et al. 2022 (4) compare with, and recursive; with squared errors, also off the geometry's edges, and of
    the changes.
    Returns: the columns of the metrics, the metrics by name, and mean changes of each pixel,
        (height, width), by name, see `answers`.
    """
    errors, changes = defaultdict(list), defaultdict(list)
    images = answer_sequence(steps_of(frames), method, constants)
    step, image = next(images)
    part, k = step.now.part, step.now.middle
    key = step.now.key(k) | {"frame": 0}
    shown = dict.fromkeys(SHOWN, image) | {"_reference": step.now.target[k]}
    sums = {name: np.zeros(image.size, np.float32) for name in ("", "_reference")}
    advance()
    for step, image in images:
        now, (accepted, places) = step.now, step.seen
        pixel, places = now.frame.surface.pixel[accepted], places[:, accepted]
        past = {name: looked_up(before, places) for name, before in shown.items()}
        shown = {
            "": image,
            "_taa": taa.blended(image, pixel, past[""]),
            "_recursive": taa.recursive(image, pixel, past["_recursive"]),
            "_reference": now.target[k],
        }
        for name, new in shown.items():
            changes[name].append(new.ravel()[pixel] - past[name])
        for name, total in sums.items():
            total[pixel] += np.abs(changes[name][-1])
        pixels_of = {"": now.valid, "_off_edges": now.off_edges}
        for name in SHOWN:
            square = np.square(shown[name] - now.target[k])
            for of, mask in pixels_of.items():
                if mask is not None:
                    errors[f"mse_sequence{of}{name}"].append(float(square[mask].mean()))
            wrong = changes[name][-1] - changes["_reference"][-1]
            errors[f"mse_change{name}"].append(float(np.square(wrong).mean()))
        advance()
    pixels = part.about["width"] * part.about["height"]
    values = {name: float(np.mean(each)) for name, each in errors.items()}
    for name, each in changes.items():
        changed = measure("of_changes", "soft", each, pixels)
        values |= {f"{metric}{name}": value for metric, value in changed.items()}
    count = len(errors["mse_sequence"])
    maps = {name: (total / count).reshape(image.shape) for name, total in sums.items()}
    path = part.frames_json
    named = {flicker_name(path): maps[""], flicker_name(path, True): maps["_reference"]}
    return key, values, named
