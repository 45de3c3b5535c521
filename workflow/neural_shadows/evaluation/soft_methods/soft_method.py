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
            [0, 1]; what faces away from the light is made dark by its caller, for all methods alike.
            Takes the constants as keyword arguments.
        constants: the values that are tried of each on validation frames; those that give the least
            error there are used, one set for each radius.
        with_map: whether it looks at the light's map.
        of_radius: whether its answer depends on the light's radius.
    """

    label: str
    answer: Callable[..., np.ndarray]
    constants: Mapping[str, Sequence[float]] = field(default_factory=dict)
    with_map: bool = True
    of_radius: bool = True

    def settings(self) -> list[dict[str, float]]:
        """Every combination of the constants that is tried; one without any, if it has none."""
        found: list[dict[str, float]] = [{}]
        for name, values in self.constants.items():
            found = [one | {name: value} for one in found for value in values]
        return found


def facing(frame: SoftFrame, visibility: np.ndarray) -> np.ndarray:
    """The visibility (n,) with what is turned from the light's centre dark."""
    return np.where(frame.cosines > 0, visibility, np.float32(0))
