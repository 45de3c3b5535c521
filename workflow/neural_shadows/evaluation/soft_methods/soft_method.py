"""What a method for soft shadows is, as the registry names it."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from neural_shadows.frames.soft_frame import SoftFrame


@dataclass(frozen=True)
class SoftMethod:
    """A way to answer how much of a spherical light a frame's n points see.

    Args:
        label: what tables call it.
        answer: of a frame and the light's radius in the scene's unit, visibilities (n,) float32 in
            [0, 1]. Takes the constants as keyword arguments.
        constants: the values that are tried of each on validation frames; those that give the least
            error there are used, one set for each radius.
        texel_floats: float32 numbers in a texel of the map that it looks at; 0 for none.
        of_radius: whether its answer depends on the light's radius.
        by_rays: whether it sends rays to the light's points. What faces away from the light's centre
            is made dark for all others: it may see a part of a large light, and rays know.
        channel: of the frame's buffers, if its answer is there already.
    """

    label: str
    answer: Callable[..., np.ndarray] | None
    constants: Mapping[str, Sequence[float]] = field(default_factory=dict)
    texel_floats: int = 1
    of_radius: bool = True
    by_rays: bool = False
    channel: str | None = None

    def settings(self) -> list[dict[str, float]]:
        """Every combination of the constants that is tried; one without any, if it has none."""
        found: list[dict[str, float]] = [{}]
        for name, values in self.constants.items():
            found = [one | {name: value} for one in found for value in values]
        return found


def visibility(
    method: SoftMethod, frame: SoftFrame, radius: float, constants: Mapping[str, float]
) -> np.ndarray:
    """How much of a light of a radius each of the frame's points sees, (n,) float32."""
    found = method.answer(frame, radius, **constants)
    return found if method.by_rays else np.where(frame.cosines > 0, found, np.float32(0))
