"""Procedural city of blocks with courtyards, towers, a church and trees.

In metres; y is up, the ground at y = 0. All parts are closed, houses without a floor stand on ground
that is open below them, so that no face lies within the solid but where parts run into each other.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import trimesh

STREET, PAVEMENT = 15.0, 2.5  # between houses' fronts; of trees from the fronts
BLOCK = (44.0, 64.0)  # sides of a block
WING = 12.0  # depth of a house
LOT = (9.0, 17.0)  # its front
EAVES = (11.0, 21.0)
SLAB = 3.0  # thickness of the ground
TURNED = np.radians(17)  # of the streets, against the axes
PARAPET, RIM = 0.9, 0.5


class Lot(NamedTuple):
    """A house's rectangle, height of its eaves, and roof."""

    low: np.ndarray  # (2,) x and z
    high: np.ndarray
    eaves: float
    ridge: int | None  # axis of the ridge, 0 or 1; None for a flat roof


Part = tuple[np.ndarray, np.ndarray]  # vertices (V, 3), faces (F, 3)


def make_city(*, blocks: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Vertices (V, 3) float64 and faces (F, 3) int64.

    Args:
        blocks: along each side.
    """
    rng = np.random.default_rng(seed)
    x, z = (_sides(rng, blocks) for _ in range(2))
    lots: list[Lot] = []
    parts: list[Part] = []
    kinds = _kinds(rng, blocks)
    for i, j in np.ndindex(blocks, blocks):
        low, high = np.array([x[i][0], z[j][0]]), np.array([x[i][1], z[j][1]])
        own, trees = _BLOCKS[kinds[i, j]](rng, low, high)
        lots += own
        parts += [_tree(rng, place) for place in [*trees, *_street_trees(rng, low, high)]]
    for lot in lots:
        parts += [_house(lot), *_on_roof(rng, lot)]
    margin = np.array([STREET, STREET])
    ends = np.array([x[0][0], z[0][0]]) - margin, np.array([x[-1][1], z[-1][1]]) + margin
    vertices, faces = _joined([_ground(lots, *ends), *parts])
    middle = np.array([ends[0][0] + ends[1][0], 0, ends[0][1] + ends[1][1]]) / 2
    turn = trimesh.transformations.rotation_matrix(TURNED, [0, 1, 0])[:3, :3]
    return (vertices - middle) @ turn.T, faces


def _sides(rng: np.random.Generator, blocks: int) -> list[tuple[float, float]]:
    """First and last coordinate of each block along an axis."""
    starts, sides = 0.0, []
    for width in rng.uniform(*BLOCK, blocks):
        sides.append((starts, starts + width))
        starts += width + STREET
    return sides


def _kinds(rng: np.random.Generator, blocks: int) -> np.ndarray:
    """Kinds of blocks, (blocks, blocks): a church, a park and a tower in the middle, courts around."""
    kinds = np.full(blocks**2, "court", object)
    special = ["church", "park", "tower", "rows", "park", "tower"]
    count = min(len(special), blocks**2 // 2)
    kinds[rng.choice(blocks**2, count, replace=False)] = special[:count]
    return kinds.reshape(blocks, blocks)


# Blocks: lots, and places of trees (n, 3) with their heights as y.


def _court(rng, low, high):
    """Houses around a courtyard; those of the sides along x have the corners."""
    lots = [
        *_row(rng, low, np.array([high[0], low[1] + WING]), 0),
        *_row(rng, np.array([low[0], high[1] - WING]), high, 0),
        *_row(rng, low + [0, WING], np.array([low[0] + WING, high[1] - WING]), 1),
        *_row(rng, np.array([high[0] - WING, low[1] + WING]), high - [0, WING], 1),
    ]
    return lots, _trees_in(rng, low + WING + 4, high - WING - 4, 5)


def _rows(rng, low, high):
    """Rows of houses with gardens between them."""
    gap = (high[1] - low[1] - 2 * WING) / 2 - WING / 2
    starts = (low[1], low[1] + WING + gap, high[1] - WING)
    rows = [((low[0], z), (high[0], z + WING)) for z in starts]
    lots = [lot for a, b in rows for lot in _row(rng, np.array(a), np.array(b), 0)]
    gardens = [z + WING + gap / 2 for z in starts[:2]]
    places = [(x, 7.0, z) for z in gardens for x in np.arange(low[0] + 5, high[0] - 5, 9)]
    return lots, np.array(places) + rng.normal(0, 0.8, (len(places), 3))


def _tower(rng, low, high):
    """A tower on a flat podium."""
    side = rng.uniform(15, 19)
    middle = low + (high - low) * rng.uniform(0.4, 0.6, 2)
    podium = [
        *_row(rng, low, np.array([high[0], low[1] + WING]), 0, flat=True),
        *_row(rng, np.array([low[0], high[1] - WING]), high, 0, flat=True),
    ]
    return (
        [*podium, Lot(middle - side / 2, middle + side / 2, rng.uniform(48, 66), None)],
        _trees_in(rng, low + [3, WING + 4], high - [3, WING + 4], 4),
    )


def _church(rng, low, high):
    """A nave with a tower and a spire, among trees."""
    middle = (low + high) / 2
    nave = Lot(middle - [17, 7], middle + [13, 7], 13.0, 0)
    aisles = [Lot(middle + [-13, z], middle + [9, z + 5], 7.0, None) for z in (-12.0, 7.0)]
    spire = Lot(middle + [13, -4], middle + [21, 4], 30.0, 2)
    return [nave, *aisles, spire], _trees_around(rng, low + 4, high - 4, 12)


def _park(rng, low, high):
    return [], _trees_in(rng, low + 4, high - 4, 34)


_BLOCKS = {"court": _court, "rows": _rows, "tower": _tower, "church": _church, "park": _park}


def _row(rng, low, high, axis, flat=False) -> Iterator[Lot]:
    """Houses side by side along an axis, between two corners."""
    length = high[axis] - low[axis]
    count = max(1, round(length / rng.uniform(*LOT)))
    shares = np.cumsum(rng.uniform(0.75, 1.25, count))
    ends = low[axis] + length * np.concatenate([[0], shares / shares[-1]])
    street = rng.uniform(*EAVES)
    for start, end in zip(ends, ends[1:]):
        first, last = low.copy(), high.copy()
        first[axis], last[axis] = start, end
        eaves = street + rng.uniform(-3, 3)
        yield Lot(first, last, eaves, None if flat or rng.random() < 0.3 else axis)


def _trees_in(rng, low, high, count) -> np.ndarray:
    """Places between two corners, at least 4 m apart: (n, 3) with heights."""
    places = np.zeros((0, 3))
    for x, z in rng.uniform(low, np.maximum(high, low + 0.1), (8 * count, 2)):
        if len(places) < count and np.all(np.hypot(*(places[:, [0, 2]] - [x, z]).T) > 4):
            places = np.vstack([places, [x, rng.uniform(6, 13), z]])
    return places


def _trees_around(rng, low, high, count) -> np.ndarray:
    """As `_trees_in`, but in a rim of 6 m."""
    places = _trees_in(rng, low, high, 4 * count)
    inside = np.all((places[:, [0, 2]] > low + 6) & (places[:, [0, 2]] < high - 6), axis=1)
    return places[~inside][:count]


def _street_trees(rng, low, high) -> np.ndarray:
    """A row along one side of a block."""
    if rng.random() < 0.35:
        return np.zeros((0, 3))
    x = np.arange(low[0] + 5, high[0] - 4, 9.5)
    return np.stack([x, rng.uniform(6, 9, len(x)), np.full(len(x), high[1] + PAVEMENT)], axis=1)


# Parts.


def _joined(parts: list[Part]) -> Part:
    counts = np.cumsum([0, *(len(vertices) for vertices, _ in parts)])
    faces = [faces + first for (_, faces), first in zip(parts, counts)]
    return np.concatenate([vertices for vertices, _ in parts]), np.concatenate(faces)


def _quads(*quads: tuple[int, int, int, int]) -> np.ndarray:
    return np.array([face for a, b, c, d in quads for face in ((a, b, c), (a, c, d))], np.int64)


def _house(lot: Lot) -> Part:
    """Walls and roof, without a floor; outward faces counter-clockwise."""
    corners = _ring(lot.low, lot.high)
    base, eaves = _raised(corners, 0.0), _raised(corners, lot.eaves)
    walls = _quads(*((k, (k + 1) % 4, 4 + (k + 1) % 4, 4 + k) for k in range(4)))
    if lot.ridge is None:
        return _flat(lot, base, walls)
    middle, sides = (lot.low + lot.high) / 2, lot.high - lot.low
    if lot.ridge == 2:  # a spire
        top = np.array([[middle[0], lot.eaves + 2.4 * sides.min(), middle[1]]])
        roof = np.array([(4 + k, 4 + (k + 1) % 4, 8) for k in range(4)])
        return np.concatenate([base, eaves, top]), np.concatenate([walls, roof])
    height = lot.eaves + 0.42 * sides[1 - lot.ridge]
    ends = [middle.copy(), middle.copy()]
    ends[0][lot.ridge], ends[1][lot.ridge] = lot.low[lot.ridge], lot.high[lot.ridge]
    ridge = np.array([[end[0], height, end[1]] for end in ends])
    vertices = np.concatenate([base, eaves, ridge])
    # Corners 0 to 3 go round by x low z low, x low z high, x high z high, x high z low.
    if lot.ridge == 0:
        roof = [*_quads((4, 8, 9, 7), (6, 9, 8, 5)), (4, 5, 8), (6, 7, 9)]
    else:
        roof = [*_quads((5, 9, 8, 4), (7, 8, 9, 6)), (5, 6, 9), (7, 4, 8)]
    return vertices, np.concatenate([walls, np.array(roof)])


def _flat(lot: Lot, base: np.ndarray, walls: np.ndarray) -> Part:
    """A roof behind a parapet."""
    inner = _ring(lot.low + RIM, lot.high - RIM)
    top = lot.eaves + PARAPET
    rings = [base, _raised(_ring(lot.low, lot.high), top), _raised(inner, top)]
    vertices = np.concatenate([*rings, _raised(inner, lot.eaves)])
    steps = [
        (4 * r + k, 4 * r + (k + 1) % 4, 4 * r + 4 + (k + 1) % 4, 4 * r + 4 + k)
        for r in (1, 2)
        for k in range(4)
    ]
    return vertices, np.concatenate([walls, _quads(*steps, (12, 13, 14, 15))])


def _ring(low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Corners (4, 2) of a rectangle, counter-clockwise seen from above (+y)."""
    return np.array([low, [low[0], high[1]], high, [high[0], low[1]]])


def _raised(corners: np.ndarray, y: float) -> np.ndarray:
    return np.insert(corners, 1, y, axis=1)


def _on_roof(rng, lot: Lot) -> Iterator[Part]:
    """Chimneys through the roof, or boxes on a flat one."""
    sides = lot.high - lot.low
    if lot.ridge == 2 or sides.min() < 6:
        return
    count, flat = rng.integers(1, 4), lot.ridge is None
    for x, z in rng.uniform(lot.low + 2, lot.high - 2, (count, 2)):
        half = rng.uniform([0.9, 0.9], [2.0, 2.0]) if flat else np.array([0.5, 0.7])
        low, high = np.array([x, z]) - half, np.array([x, z]) + half
        top = rng.uniform(1.5, 3.0) if flat else 0.42 * sides[1 - lot.ridge] + 1.2
        yield _box(low, high, lot.eaves - 1.5, lot.eaves + top)
    if not flat and rng.random() < 0.7:
        yield from _dormers(lot)


def _dormers(lot: Lot) -> Iterator[Part]:
    """Small houses in both sides of a gabled roof."""
    along, across = lot.ridge, 1 - lot.ridge
    for place in np.arange(lot.low[along] + 2.2, lot.high[along] - 2.0, 3.6):
        for side in (lot.low[across] + 1.2, lot.high[across] - 3.2):
            low, high = np.zeros(2), np.zeros(2)
            low[along], high[along] = place - 0.8, place + 0.8
            low[across], high[across] = side, side + 2.0
            yield _box(low, high, lot.eaves - 1.5, lot.eaves + 2.3)


def _box(low: np.ndarray, high: np.ndarray, bottom: float, top: float) -> Part:
    corners = _ring(low, high)
    vertices = np.concatenate([_raised(corners, bottom), _raised(corners, top)])
    sides = [(k, (k + 1) % 4, 4 + (k + 1) % 4, 4 + k) for k in range(4)]
    return vertices, _quads(*sides, (4, 5, 6, 7), (3, 2, 1, 0))


def _tree(rng, place: np.ndarray) -> Part:
    """A trunk and a crown of a lumpy ball."""
    x, height, z = place
    crown = trimesh.creation.icosphere(3)
    lumps = rng.normal(size=(7, 3))
    lumps /= np.linalg.norm(lumps, axis=1, keepdims=True)
    bulge = np.exp(6 * (crown.vertices @ lumps.T - 1)).sum(axis=1)
    radius = height * rng.uniform(0.24, 0.32)
    vertices = crown.vertices * (radius * (0.75 + 0.3 * bulge))[:, None] * [1, 1.15, 1]
    vertices += [x, height - 1.1 * radius, z]
    trunk = _box(np.array([x, z]) - 0.25, np.array([x, z]) + 0.25, 0.0, height - radius)
    return _joined([(vertices, np.asarray(crown.faces, np.int64)), trunk])


def _ground(lots: list[Lot], low: np.ndarray, high: np.ndarray) -> Part:
    """The ground around houses, with sides and bottom of a slab."""
    cuts = [
        np.unique([low[k], high[k], *(end for lot in lots for end in (lot.low[k], lot.high[k]))])
        for k in (0, 1)
    ]
    x, z = ((cut[1:] + cut[:-1]) / 2 for cut in cuts)
    free = np.ones((len(x), len(z)), bool)
    for lot in lots:
        inside = [(lot.low[k] < each) & (each < lot.high[k]) for k, each in enumerate((x, z))]
        free &= ~np.outer(*inside)
    grid = np.stack(np.meshgrid(*cuts, indexing="ij"), axis=-1).reshape(-1, 2)
    number = np.arange(len(grid)).reshape(len(cuts[0]), len(cuts[1]))
    i, j = np.nonzero(free)
    quads = zip(number[i, j], number[i, j + 1], number[i + 1, j + 1], number[i + 1, j])
    top = _raised(grid, 0.0), _quads(*quads)
    ring = _ring(low, high)
    rim = np.concatenate([_raised(ring, -SLAB), _raised(ring, 0.0)])
    sides = [(k, (k + 1) % 4, 4 + (k + 1) % 4, 4 + k) for k in range(4)]
    return _joined([top, (rim, _quads(*sides, (3, 2, 1, 0)))])
