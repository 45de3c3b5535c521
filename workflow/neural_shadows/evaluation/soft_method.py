"""A soft-shadow method and its settings."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from neural_shadows.evaluation.look import Look

if TYPE_CHECKING:  # the graph needs metadata alone
    from neural_shadows.frames.frame_set import FrameSetPart
    from neural_shadows.frames.soft_frame import SoftFrame
    from neural_shadows.rendering.surface import Surface

Constants = Mapping[str, float]


@dataclass(frozen=True)
class SoftMethod:
    """A method for visibility of spherical lights at frames' points.

    Args:
        answer: of a frame and the light's radius in the scene's unit, visibilities (n,) float32 in
            [0, 1]. Takes the constants as keyword arguments. None if `of_buffers`, `channel` or
            `constant` is given.
        constants: the candidates of each; those of the least error on validation frames are used,
            one set for each radius.
        label: its name in tables and figures.
        tuned_as: key of the method with its constants, if not its own.
        fields: needs fields fitted to a scene's objects.
        package: a required optional package.
        rays: of a pixel, of a plain ray tracer.
        null: a null predictor, which a network must beat.
        look: if not its family's.
        sequence: of a sequence of frames, if it has a history: of the frames, the radius, where
            points were before (`was`) and the constants, the visibilities of each frame in turn.
        texel_floats: float32 numbers in a texel of its light map; 0 for none.
        held: of a frame, bytes in memory of the scene's data beside the triangles.
        of_radius: visibility depends on the light's radius.
        by_rays: sends rays to the light's points. All others are dark where a surface faces away
            from the light's centre, though it may see a part of a large light.
        of_buffers: of a frame's buffers by name (height, width), the camera's `Lens`, the radius and
            the scene's size, visibilities (height, width) float32, if it needs buffers alone; `answer`
            then computes the buffers, for timing.
        check_own: of a part of a user's own frames, raises an InputError for unsuitable ones.
        channel: the frame's buffer with its visibility, if stored.
        constant: the visibility of all surfaces facing the light.
        last: a filter of a surface and visibilities (n,) in screen space, after all else, so that the
            border of surfaces that face away is filtered, too.
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
        """All combinations of constants; one empty without any."""
        combinations: list[dict[str, float]] = [{}]
        for name, values in self.constants.items():
            combinations = [
                combination | {name: value} for combination in combinations for value in values
            ]
        return combinations

    def changes_at(self, constants: Sequence[Constants], radius: int) -> bool:
        """Check for a change of visibility from the radius before. Radii are counted from 0.

        Args:
            constants: by radius.
        """
        return radius == 0 or self.of_radius or constants[radius] != constants[radius - 1]


def visibility(
    method: SoftMethod, frame: "SoftFrame", radius: float, constants: Constants
) -> np.ndarray:
    """A method's visibility at a frame's points, (n,) float32."""
    if method.resolution is not None:
        frame = frame.with_map_of(method.resolution)
    shares = method.answer(frame, radius, **constants)
    if not method.by_rays and method.of_buffers is None:
        shares = np.where(frame.cosines > 0, shares, np.float32(0))
    return shares if method.last is None else method.last(frame.surface, shares)


def rays_label(count: int) -> str:
    """`1 ray`, `4 rays`."""
    return f"{count} ray{'s' if count > 1 else ''}"
