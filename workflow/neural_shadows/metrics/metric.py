"""A metric: its name and unit, and its error scale."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np

Light = Literal["hard", "soft"]  # of a frame: without extent, or not
EDGE_PIXELS = 3  # near an edge of the hard shadow, on each side of it
ARROWS = {"low": " ↓", "high": " ↑", None: ""}


@dataclass(frozen=True)
class Metric:
    """A metric of frames.

    Args:
        name: in headings and sentences. part: of the pixels, `off edges`; empty for all.
        unit: of tables, `%`. factor: of values, to that unit.
        digits: behind the point, in tables.
        better: None of a number that is no error.
        lights: of the frames with this metric; none of what tables compute from others.
        slow: measured of few soft frames alone, the first of each part, by the middle light.
        comparable: with printed values.
        to_error, from_error: to the error that frames are averaged in and power laws are fitted
            to, falling to 0, and back; by default the value, or 1 − value where `high` is better.
    """

    name: str
    part: str = ""
    unit: str = ""
    factor: float = 1
    digits: int = 4
    better: Literal["low", "high"] | None = "low"
    lights: tuple[Light, ...] = ("hard", "soft")
    slow: bool = False
    comparable: bool = True
    to_error: Callable[[np.ndarray], np.ndarray] | None = None
    from_error: Callable[[np.ndarray], np.ndarray] | None = None

    @property
    def label(self) -> str:
        """Name, with the unit of scaled values: `MSE × 10⁻⁴`, `L1 %`."""
        return _joined(self.name, self.unit if self.factor != 1 else "", self.part)

    @property
    def heading(self) -> str:
        """Heading of a column: `MSE × 10⁻⁴ ↓`."""
        return self.label + ARROWS[self.better]

    @property
    def text(self) -> str:
        """Name in sentences: `L1 in %`."""
        return self.label.replace(" %", " in %")

    def score(self, value: float, digits: int | None = None) -> str:
        """Name and value: `PSNR 27.39 dB`."""
        number = f"{value * self.factor:.{self.digits if digits is None else digits}f}"
        return _joined(self.name, number, self.unit)

    def error(self, value: np.ndarray) -> np.ndarray:
        """Errors of values, see `to_error`."""
        if self.to_error:
            return self.to_error(value)
        return 1 - value if self.is_complement else value

    def value(self, error: np.ndarray) -> np.ndarray:
        """Values of errors."""
        if self.from_error:
            return self.from_error(error)
        return 1 - error if self.is_complement else error

    @property
    def is_complement(self) -> bool:
        """Whether its error is 1 − value."""
        return self.better == "high" and self.to_error is None


def _joined(*words: str) -> str:
    return " ".join(word for word in words if word)


@dataclass(frozen=True, eq=False)
class Pixels:
    """Masks of a frame's pixels, of the shape of its visibility.

    Args:
        valid: bool, pixels in metrics. hard: visibility of the light's centre; None if unknown.
        off_edges: those of `valid` off edges of the geometry; None if unknown.
    """

    valid: np.ndarray
    hard: np.ndarray | None = None
    off_edges: np.ndarray | None = None

    @cached_property
    def near_edges(self) -> np.ndarray:
        """Pixels near an edge of the hard shadow, bool; none if it is unknown.

        An edge is between two valid neighbours of which one is lit and the other is not.
        """
        from scipy.ndimage import binary_dilation

        valid = self.valid
        if self.hard is None:
            return np.zeros_like(valid)
        lit = self.hard > 0.5
        edge = np.zeros_like(lit)
        across = (lit[1:] != lit[:-1]) & valid[1:] & valid[:-1]
        edge[1:] |= across
        edge[:-1] |= across
        along = (lit[:, 1:] != lit[:, :-1]) & valid[:, 1:] & valid[:, :-1]
        edge[:, 1:] |= along
        edge[:, :-1] |= along
        return binary_dilation(edge, np.ones((2 * EDGE_PIXELS - 1,) * 2, bool))
