"""A method's answers to consecutive frames."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from neural_shadows.evaluation.measured_frames import MeasuredFrame
from neural_shadows.evaluation.method import Constants, Method
from neural_shadows.frames.soft_frame import SoftFrame
from neural_shadows.frames.uses import RUN_IN
from neural_shadows.rendering.reprojection import Reprojection


@dataclass(frozen=True, eq=False)
class Step:
    """A frame of a sequence, and what is alike for all constants of a method; `before`: None at first."""

    now: MeasuredFrame
    before: MeasuredFrame | None

    @cached_property
    def back(self) -> Reprojection:
        """To the frame before; of the first, which rests, to itself."""
        now, before = self.now, self.before
        surface = now.frame.surface
        if before is None:
            return Reprojection(surface, surface)
        motions = (frame.part.setting(frame.number).motion for frame in (now, before))
        was = now.scene.before(now.frame.scene, surface.face, surface.p, *motions)
        return Reprojection(surface, before.frame.surface, was)

    @cached_property
    def frames(self) -> list[SoftFrame]:
        """The frame, by its number in the sequence. Before the first, `RUN_IN` times the same at rest.

        They keep their rays: with these and `back` four settings took 0.31 to 0.54 of their time without.
        """
        frame = self.now.frame
        at_rest = range(RUN_IN if self.before is None else 0)
        return [replace(frame, number=number) for number in (*at_rest, RUN_IN + frame.number)]

    @property
    def seen(self) -> tuple[np.ndarray, np.ndarray] | None:
        """Valid points seen in the frame before, and where (see `Reprojection.seen`). None at first."""
        if self.before is None:
            return None
        accepted, places = self.back.seen
        return accepted & self.now.valid.ravel()[self.now.frame.surface.pixel], places


def steps_of(frames: Iterable[MeasuredFrame]) -> Iterator[Step]:
    """The steps of a sequence."""
    before = None
    for now in frames:
        yield Step(now, before)
        before = now


def answer_sequence(
    steps: Iterable[Step], method: Method, constants: Sequence[Constants]
) -> Iterator[tuple[Step, np.ndarray]]:
    """Each step and the method's image of it, by the middle radius.

    A method with a history runs through all frames in turn, after `RUN_IN` of the first.
    """
    next_frame = None
    for step in steps:
        now = step.now
        radius, chosen = now.part.radii[now.middle], constants[now.middle]
        if method.sequence is None:
            yield step, now.answered(method, radius, chosen)
            continue
        if next_frame is None:
            next_frame = method.sequence(radius, **chosen)
        for frame in step.frames:
            visibility = next_frame(frame, step.back if frame.number else None)
        yield step, now.frame.surface.image(visibility, 1.0)


def squared_error(steps: Sequence[Step], method: Method, constants: Constants) -> float:
    """Mean squared error off edges of a sequence's frames after the first, by the middle radius."""
    of_all = [constants] * len(steps[0].now.part.radii)
    squares = [
        np.square(image - step.now.target[step.now.middle])[step.now.judged].mean()
        for step, image in answer_sequence(steps, method, of_all)
    ]
    return float(np.mean(squares[1:]))
