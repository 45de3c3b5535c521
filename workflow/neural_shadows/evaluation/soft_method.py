"""A method for soft shadows, as its family describes it."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from neural_shadows.evaluation.look import Look

if TYPE_CHECKING:  # the graph needs labels and the like alone
    from neural_shadows.frames.frame_set import FrameSetPart
    from neural_shadows.frames.soft_frame import SoftFrame
    from neural_shadows.rendering.surface import Surface

Constants = Mapping[str, float]


@dataclass(frozen=True)
class SoftMethod:
    """How much of a spherical light a frame's n points see, by one method.

    Args:
        answer: of a frame and the light's radius in the scene's unit, visibilities (n,) float32 in
            [0, 1]. Takes the constants as keyword arguments. None if `of_buffers`, `channel` or
            `constant` is given.
        constants: the values that are tried of each on validation frames; those that give the least
            error there are used, one set for each radius.
        label: its name in tables and figures.
        tuned_as: key of the method whose constants it has, if not its own.
        fields: whether it needs fields that are fitted to a scene's objects.
        package: an optional one that it needs.
        rays: of a pixel, if it sends rays and does nothing else.
        null: whether it learns nothing, so that a network must be better.
        look: if not its family's.
        sequence: of a sequence of frames, if it has a history: of the frames, the radius, where
            points were before (`was`) and the constants, the visibilities of each frame in turn.
        texel_floats: float32 numbers in a texel of the map that it looks at; 0 for none.
        held: of a frame, the bytes in memory of what it keeps of the scene beside the triangles.
        of_radius: whether its visibility depends on the light's radius.
        by_rays: whether it sends rays to the light's points. What faces away from the light's centre
            is made dark for all others: it may see a part of a large light, and rays know.
        of_buffers: of a frame's buffers by name (height, width), the camera's `Lens`, the radius and
            the scene's size, visibilities (height, width) float32, if buffers are all that it needs;
            `answer` then makes them, to be timed.
        check_own: of a part of a user's own frames, raises an InputError where it cannot answer them.
        channel: of the frame's buffers, if its visibility is there already.
        constant: the visibility of all that faces the light, whatever the scene.
        last: a filter of a surface and visibilities (n,) in screen space, after all else: also after
            what faces away is made dark, whose border would stay aliased.
        resolution: texels of a side of the light's map, if not the frame set's.
    """

    answer: Callable[..., np.ndarray] | None = None
    constants: Mapping[str, Sequence[float]] = field(default_factory=dict)
    label: str = ""
    tuned_as: str | None = None
    fields: bool = False
    package: str | None = None
    rays: int | None = None
    null: bool = False
    look: Look | None = None
    sequence: Callable[..., Iterator[np.ndarray]] | None = None
    texel_floats: int = 1
    held: "Callable[[SoftFrame], int] | None" = None
    of_radius: bool = True
    by_rays: bool = False
    of_buffers: Callable[..., np.ndarray] | None = None
    check_own: "Callable[[FrameSetPart], None] | None" = None
    channel: str | None = None
    constant: float | None = None
    last: "Callable[[Surface, np.ndarray], np.ndarray] | None" = None
    resolution: int | None = None

    def settings(self) -> list[dict[str, float]]:
        """Every combination of the constants that is tried; one without any, if it has none."""
        combinations: list[dict[str, float]] = [{}]
        for name, values in self.constants.items():
            combinations = [one | {name: value} for one in combinations for value in values]
        return combinations

    def changes_at(self, constants: Sequence[Constants], radius: int) -> bool:
        """Whether its visibility at a radius, counted from 0, differs from that at the one before.

        Args:
            constants: that it has at each radius.
        """
        return radius == 0 or self.of_radius or constants[radius] != constants[radius - 1]


def visibility(
    method: SoftMethod, frame: "SoftFrame", radius: float, constants: Constants
) -> np.ndarray:
    """How much of a light of a radius each of the frame's points sees, (n,) float32."""
    if method.resolution is not None:
        frame = frame.with_map_of(method.resolution)
    visible = method.answer(frame, radius, **constants)
    if not method.by_rays and method.of_buffers is None:
        visible = np.where(frame.cosines > 0, visible, np.float32(0))
    return visible if method.last is None else method.last(frame.surface, visible)


def rays_label(count: int) -> str:
    """`1 ray`, `4 rays`."""
    return f"{count} ray{'s' if count > 1 else ''}"
