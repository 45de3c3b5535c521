"""A method's answers to consecutive frames."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

import numpy as np

from neural_shadows.evaluation.measured_frames import MeasuredFrame
from neural_shadows.evaluation.method import Constants, Method
from neural_shadows.frames.uses import RUN_IN
from neural_shadows.rendering.reprojection import seen_before

Seen = tuple[np.ndarray, np.ndarray]


def answer_sequence(
    frames: Iterable[MeasuredFrame], method: Method, constants: Sequence[Constants]
) -> Iterator[tuple[MeasuredFrame, np.ndarray, Seen | None]]:
    """Each frame, the method's image by the middle radius, and what is still visible.

    The last is None at first. A method with a history runs through all frames in turn, after `RUN_IN`
    of the first.
    """
    step = before = None
    for now in frames:
        k = now.middle
        radius, chosen = now.part.radii[k], constants[k]
        seen, points = _seen(before, now) if before else (None, None)
        if method.sequence is None:
            image = now.answered(method, radius, chosen)
        else:
            if step is None:
                step = method.sequence(radius, **chosen)
                for number in range(RUN_IN):
                    step(replace(now.frame, number=number), None)
            later = replace(now.frame, number=RUN_IN + now.frame.number)
            image = now.frame.surface.image(step(later, points), 1.0)
        yield now, image, seen
        before = now


def squared_error(frames: Sequence[MeasuredFrame], method: Method, constants: Constants) -> float:
    """Mean squared error off edges of a sequence's frames after the first, by the middle radius."""
    of_all = [constants] * len(frames[0].part.radii)
    _, *later = answer_sequence(frames, method, of_all)
    squares = [np.square(image - f.target[f.middle])[f.judged].mean() for f, image, _ in later]
    return float(np.mean(squares))


def _seen(before: MeasuredFrame, now: MeasuredFrame) -> tuple[Seen, np.ndarray]:
    """Reprojection of valid points into the previous frame.

    Accepted points and their pixels there (see `seen_before`), and their previous positions (n, 3).
    """
    surface, scene = now.frame.surface, now.scene
    motions = (frame.part.setting(frame.number).motion for frame in (now, before))
    points_before = scene.before(now.frame.scene, surface.face, surface.p, *motions)
    accepted, pixels_before = seen_before(surface, before.frame.surface, points_before)
    return (accepted & now.valid.ravel()[surface.pixel], pixels_before), points_before
