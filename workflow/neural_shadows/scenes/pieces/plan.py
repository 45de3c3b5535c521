"""Floor plans: rectangles without overlap."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from neural_shadows.scenes.arrangement import Placed, Spot
from neural_shadows.scenes.pieces.shapes import Shape, at, placed

_TRIES = 60
_MOST_TRIANGLES = 36_000  # of a scene before its last piece; fixed scenes have 10,000 to 60,000

Drawn = tuple[Shape, float, float]  # a piece, its width along x and its depth along z
Kind = Callable[[np.random.Generator], Drawn]


@dataclass(eq=False)
class Plan:
    """A floor about the origin with occupied rectangles; metres."""

    width: float  # along x
    depth: float  # along z
    # Corners (2,) of each, and the height of its object.
    taken: list[tuple[np.ndarray, np.ndarray, float]] = field(default_factory=list)

    def take(self, low, high, top: float = np.inf) -> None:
        """Occupy a rectangle between corners (x, z).

        Args:
            top: height of the object; infinite if nothing may hang above it.
        """
        self.taken.append((np.asarray(low, float), np.asarray(high, float), top))

    def is_free(self, low: np.ndarray, high: np.ndarray) -> bool:
        """Check for a free rectangle on the floor."""
        half = np.array([self.width, self.depth]) / 2
        if (low < -half).any() or (high > half).any():
            return False
        return all((high <= a).any() or (low >= b).any() for a, b, _ in self.taken)

    def is_under(self, low: np.ndarray, high: np.ndarray, bottom: float) -> bool:
        """Check for objects below `bottom` in a rectangle."""
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
        """Draw a free rectangle and occupy it; None after 60 failures.

        Returns:
            The rectangle's middle, (3,) float64 on y = 0.

        Args:
            low, high: corners (x, z) of the range of the middle; default: the whole floor.
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


def free_spot(rng: np.random.Generator, plan: Plan, sides: Sequence[float], low, high) -> Spot:
    """Draw a free spot, as high as wide, of the first of `sides` that finds room.

    In the back corner if none does.

    Args:
        low, high: corners (x, z) of the range of its middle.
    """
    for side in sides:
        position = plan.place(rng, side, side, low, high)
        if position is not None:
            break
    else:
        position = np.array([plan.width / 2 - side, 0, -plan.depth / 2 + side])
    return Spot(position, side, rng.uniform(0, 2 * np.pi))


def furnish(
    rng: np.random.Generator,
    plan: Plan,
    kinds: Sequence[Kind],
    pieces: int,
    others: Sequence[Placed],
) -> list[Placed]:
    """Draw pieces of kinds in turn, rotated by quarters, where free.

    Args:
        others: previous objects of the scene; many triangles leave fewer pieces.
    """
    objects: list[Placed] = []
    for number in range(pieces):
        piece, width, depth = kinds[number % len(kinds)](rng)
        turn = rng.integers(4)
        size = (width, depth) if turn % 2 == 0 else (depth, width)
        position = plan.place(rng, *size, top=piece.bounds[1, 1])
        if position is not None:
            shape = at(piece, position, turn * np.pi / 2 + rng.uniform(-0.05, 0.05))
            objects.append(placed(f"piece {number + 1}", shape))
        if sum(len(item.faces) for item in [*others, *objects]) > _MOST_TRIANGLES:
            break
    return objects
