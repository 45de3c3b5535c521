"""Where things stand on a floor: rectangles that are clear of each other."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from neural_shadows.scenes.arrangement import Placed
from neural_shadows.scenes.generators.shapes import Shape, at, placed

_TRIES = 60
_MOST_TRIANGLES = (
    36_000  # of a scene before its last piece: as today's scenes, which have 10,000 to 60,000
)

Drawn = tuple[Shape, float, float]  # a piece, its width along x and its depth along z
Kind = Callable[[np.random.Generator], Drawn]


@dataclass(eq=False)
class Plan:
    """A floor about the origin, and the rectangles of it that are taken; x and z in metres."""

    width: float  # along x
    depth: float  # along z
    # Corners (2,) of each, and the height of what stands there.
    taken: list[tuple[np.ndarray, np.ndarray, float]] = field(default_factory=list)

    def take(self, low, high, top: float = np.inf) -> None:
        """Keep a rectangle between corners (x, z) free of what is placed later.

        Args:
            top: height of what stands there; infinite where nothing may hang over it.
        """
        self.taken.append((np.asarray(low, float), np.asarray(high, float), top))

    def is_free(self, low: np.ndarray, high: np.ndarray) -> bool:
        """Whether a rectangle lies on the floor and overlaps none that is taken."""
        half = np.array([self.width, self.depth]) / 2
        if (low < -half).any() or (high > half).any():
            return False
        return all((high <= a).any() or (low >= b).any() for a, b, _ in self.taken)

    def is_under(self, low: np.ndarray, high: np.ndarray, bottom: float) -> bool:
        """Whether all that stands in a rectangle is lower than `bottom`."""
        overlapped = (top for a, b, top in self.taken if (high > a).all() and (low < b).all())
        return all(top < bottom for top in overlapped)

    def place(
        self,
        rng: np.random.Generator,
        width: float,
        depth: float,
        low=None,
        high=None,
        top: float = np.inf,
    ) -> np.ndarray | None:
        """Draw where a rectangle is free and take it; None if 60 draws overlap others.

        Returns:
            The rectangle's middle, (3,) float64 on y = 0.

        Args:
            low, high: corners (x, z) of where the middle may be; default: the whole floor.
            top: see `take`.
        """
        half = np.array([width, depth]) / 2
        end = np.array([self.width, self.depth]) / 2 - half
        low = -end if low is None else np.maximum(low, -end)
        high = end if high is None else np.minimum(high, end)
        if (low > high).any():
            return None
        for _ in range(_TRIES):
            middle = rng.uniform(low, high)
            if self.is_free(middle - half, middle + half):
                self.take(middle - half, middle + half, top)
                return np.array([middle[0], 0.0, middle[1]])
        return None


def furnish(
    rng: np.random.Generator,
    plan: Plan,
    kinds: Sequence[Kind],
    pieces: int,
    others: Sequence[Placed],
) -> list[Placed]:
    """Draw pieces of some kinds in turn, turned by quarters, where the plan has room for them.

    Args:
        others: objects that the scene has already; there are fewer pieces beside many triangles.
    """
    objects: list[Placed] = []
    for number in range(pieces):
        piece, width, depth = kinds[number % len(kinds)](rng)
        turn = rng.integers(4)
        size = (width, depth) if turn % 2 == 0 else (depth, width)
        place = plan.place(rng, *size, top=piece.bounds[1, 1])
        if place is not None:
            shape = at(piece, place, turn * np.pi / 2 + rng.uniform(-0.05, 0.05))
            objects.append(placed(f"piece {number + 1}", shape))
        if sum(len(one.faces) for one in [*others, *objects]) > _MOST_TRIANGLES:
            break
    return objects
