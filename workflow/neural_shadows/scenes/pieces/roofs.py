"""Roofs of a court: pergolas, sails, tree crowns, wires."""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from neural_shadows.scenes.arrangement import Placed
from neural_shadows.scenes.pieces import outdoors
from neural_shadows.scenes.pieces.hanging import frame_over, ring_lamp, wires
from neural_shadows.scenes.pieces.plan import Plan
from neural_shadows.scenes.pieces.shapes import Shape, at, joined, placed, smooth

LOWEST = 1.9  # metres: the light is not lower over a court without roofs
_TRIES = 60


@dataclass(eq=False)
class Site:
    """Ground for posts, and occupied space above.

    Args:
        middle: (3,) of the targets. front: largest z of roofs, towards the cameras.
    """

    ground: Plan
    middle: np.ndarray
    front: float
    sky: Plan = field(init=False)

    def __post_init__(self):
        self.sky = Plan(self.ground.width, self.ground.depth)

    def stands(self, feet: np.ndarray, low, high) -> bool:
        """Occupy posts (n, 3) and the space between corners, if free."""
        low, high = np.asarray(low), np.asarray(high)
        squares = [(foot[[0, 2]] - 0.1, foot[[0, 2]] + 0.1) for foot in feet]
        free = all(self.ground.is_free(*square) for square in squares)
        if high[1] > self.front or not free or not self.sky.is_free(low, high):
            return False
        self.sky.take(low, high)
        for square in squares:
            self.ground.take(*square)
        return True


def draw_roofs(rng: np.random.Generator, site: Site) -> tuple[list[Placed], float]:
    """Two or three kinds of roofs, and their largest height."""
    objects, tops = [], [LOWEST]
    for kind in rng.permutation(len(_KINDS))[: rng.integers(2, 4)]:
        drawn = _KINDS[kind](rng, site)
        if drawn is not None:
            objects.append(placed(f"roof {len(objects) + 1}", drawn[0]))
            tops.append(drawn[1])
    return objects, max(tops)


Roof = tuple[Shape, float]  # and the height of its top


def _pergola(rng: np.random.Generator, site: Site) -> Roof | None:
    """A pergola with its slats along x or z."""
    for _ in range(_TRIES):
        size, turn = rng.uniform([1.6, 1.4], [3.0, 2.4]), rng.integers(2)
        half = (size if turn == 0 else size[::-1]) / 2
        position = site.middle + rng.uniform([-1.4, 0, -1.2], [1.4, 0, 0.8])
        signs = np.array([[-1, 0, -1], [-1, 0, 1], [1, 0, -1], [1, 0, 1]])
        feet = position + signs * [half[0], 0, half[1]]
        if site.stands(feet, position[[0, 2]] - half, position[[0, 2]] + half):
            height, apart = rng.uniform(1.9, 2.3), rng.uniform(0.13, 0.26)
            slat = (rng.uniform(0.03, 0.08), rng.uniform(0.04, 0.08))
            shape = outdoors.pergola(*size, height, round(size[0] / apart), slat)
            return at(shape, position, turn * np.pi / 2), height + 0.1
    return None


def _sail(rng: np.random.Generator, site: Site) -> Roof | None:
    """Bands of cloth with gaps between four poles of uneven height."""
    for _ in range(_TRIES):
        half = rng.uniform([0.8, 0.7], [1.4, 1.1])
        position = site.middle + rng.uniform([-1.4, 0, -1.2], [1.4, 0, 0.8])
        signs = np.array([[-1, 0, -1], [1, 0, -1], [1, 0, 1], [-1, 0, 1]])
        feet = position + signs * [half[0], 0, half[1]]
        if site.stands(feet, position[[0, 2]] - half, position[[0, 2]] + half):
            heights = rng.uniform(1.75, 2.3, 4)
            corners = feet + heights[:, None] * [0, 1, 0]
            bands, share = rng.integers(3, 7), rng.uniform(0.45, 0.7)
            cloths = [_band(corners, k / bands, (k + share) / bands) for k in range(bands)]
            poles = [outdoors.pole(foot, high + 0.06) for foot, high in zip(feet, heights)]
            return joined(*cloths, *poles), float(heights.max())
    return None


def _band(corners: np.ndarray, start: float, end: float) -> Shape:
    """A band of a sagging cloth between four corners (4, 3)."""
    v, u = np.meshgrid(np.linspace(start, end, 9), np.linspace(0, 1, 25), indexing="ij")
    weights = np.stack([(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v], axis=-1)
    sag = 1.4 * (u * (1 - u) * v * (1 - v))[..., None]
    return smooth(weights @ corners - sag * [0, 1, 0])


def _crown(rng: np.random.Generator, site: Site) -> Roof | None:
    """A tree with its crown above the middle."""
    for _ in range(_TRIES):
        position = site.middle + rng.uniform([-1.6, 0, -1.3], [1.6, 0, 0.3])
        if site.stands(position[None], position[[0, 2]] - 0.7, position[[0, 2]] + 0.7):
            limbs = outdoors.tree(rng, rng.uniform(0.75, 1.0), 5, rng.uniform(0.07, 0.12))
            shape = joined(*limbs)
            return at(shape, position), float(shape.bounds[1, 1])
    return None


def _strung(rng: np.random.Generator, site: Site) -> Roof | None:
    """Two frames with wires between them."""
    back = -site.ground.depth / 2 + 0.4
    for _ in range(_TRIES):
        half = rng.uniform(1.4, 2.2)
        x = site.middle[0] + rng.uniform(-0.6, 0.6)
        zs = rng.uniform([back, site.middle[2]], [back + 1.2, site.front])
        ends = np.array([[[x - half, 0, z], [x + half, 0, z]] for z in zs])
        nowhere = np.array([x, zs[0]])
        if zs[1] - zs[0] > 1.2 and site.stands(ends.reshape(-1, 3), nowhere, nowhere):
            break
    else:
        return None
    height, count = rng.uniform(1.95, 2.3), rng.integers(4, 8)
    starts, stops = (
        beam[0] + own * (beam[1] - beam[0]) + [0, height - 0.04, 0]
        for beam, own in zip(ends, rng.uniform(0.05, 0.95, (2, count, 1)))
    )
    under = [
        beam[0] + own * (beam[1] - beam[0]) + [0, height - 0.14, 0]
        for beam in ends
        for own in rng.uniform([0.15, 0.55], [0.45, 0.85])
    ]
    lamps = [at(ring_lamp(rng.uniform(0.2, 0.5), rng.uniform(0.2, 0.35)), point) for point in under]
    bulbs = rng.random() < 0.5
    strings = wires(rng, starts, stops, bulbs=bulbs, pennants=not bulbs)
    return joined(frame_over(ends, height), strings, *lamps), height


_KINDS: tuple[Callable[[np.random.Generator, Site], Roof | None], ...] = (
    *(_pergola, _sail, _crown, _strung),
)
