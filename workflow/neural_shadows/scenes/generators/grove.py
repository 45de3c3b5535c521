"""Random groves of 6 m to 9 m: foliage, thin rods, and a thin screen before the cameras.

The seed determines size, objects, lights and cameras.
"""

import numpy as np

from neural_shadows.scenes.arrangement import Arrangement, Placed, Region
from neural_shadows.scenes.pieces import outdoors
from neural_shadows.scenes.pieces.building import floor
from neural_shadows.scenes.pieces.furniture import bench, grille, plant
from neural_shadows.scenes.pieces.hanging import wires
from neural_shadows.scenes.pieces.plan import Drawn, Kind, Plan, free_spot, furnish
from neural_shadows.scenes.pieces.shapes import Shape, at, bars, joined, placed

BESIDE = 0.85  # least distance of lights to objects, metres: room for a light of 0.5 m


def arrange(rng: np.random.Generator) -> Arrangement:
    """Trees and rods about the middle, a screen near the eye, a far floor behind."""
    width, depth = rng.uniform([6.0, 5.4], [9.0, 7.8])
    plan = Plan(width - 0.5, depth - 0.5)
    middle = np.array([rng.uniform(-0.08, 0.08) * width, 0, rng.uniform(-0.14, -0.04) * depth])
    half, low = rng.uniform(0.8, 1.5), rng.uniform(1.1, 1.7)
    near = min(middle[2] + rng.uniform(1.8, 2.4), depth / 2 - 1.0)
    x = middle[0] + rng.uniform(-0.5, 0.5)
    cameras = Region(np.array([x - half, low, near]), np.array([x + half, low + 0.7, near + 0.6]))
    plan.take(cameras.low[[0, 2]] - [0.2, 0.4], cameras.high[[0, 2]] + 0.2)

    objects = [placed("ground", floor(width, depth))]
    screen, wide = _SCREENS[rng.integers(len(_SCREENS))], rng.uniform(1.2, 2.0)
    before = np.array([x + rng.uniform(-0.8, 0.8), 0, near - rng.uniform(0.75, 1.0)])
    objects.append(placed("screen", at(screen(rng, wide), before, rng.uniform(-0.3, 0.3))))
    plan.take(before[[0, 2]] - [wide / 2 + 0.3, 0.4], before[[0, 2]] + [wide / 2 + 0.3, 0.4])
    sides, about = np.array([1, 0.75, 0.5]), (middle[[0, 2]] - 2.0, middle[[0, 2]] + 2.0)
    spots = tuple(free_spot(rng, plan, side * sides, *about) for side in (1.0, 0.8))
    trees, top = _trees(rng, plan, middle)
    objects += trees
    kinds = [_KINDS[k] for k in rng.choice(len(_KINDS), 4, replace=False)]
    objects += furnish(rng, plan, kinds, rng.integers(8, 15), objects)
    objects.append(placed("bench", _bench(rng, plan, middle)))
    objects.append(placed("grass", outdoors.grass(rng, 0.8 * width, 0.5 * depth, 400)))
    reach = rng.uniform([0.5, 0.1, 0.4], [1.3, 0.5, 1.0])
    centre = middle + rng.uniform([-1.0, 0, -0.8], [1.0, 0, 0.8])
    centre[1] = top + BESIDE + rng.uniform(0.0, 0.6) + reach[1]
    return Arrangement(
        "grove",
        tuple(objects),
        spots,
        lights=Region(centre - reach, centre + reach),
        cameras=cameras,
        targets=Region(middle + [-1.6, 0.0, -1.4], middle + [1.6, 0.9, 0.8]),
        mover="bench",
    )


def _trees(rng: np.random.Generator, plan: Plan, middle: np.ndarray) -> tuple[list[Placed], float]:
    """Two or three trees, of wide or narrow leaves; and the largest height."""
    objects, top = [], 1.9
    for number in range(rng.integers(2, 4)):
        position = plan.place(rng, 0.5, 0.5, middle[[0, 2]] - 2.2, middle[[0, 2]] + [2.2, 0.6])
        if position is None:
            continue
        orders = 5 if number == 0 else 4  # of 20,720 and 11,792 triangles
        limbs = joined(
            *outdoors.tree(rng, rng.uniform(0.55, 0.95), orders, rng.uniform(0.04, 0.14))
        )
        # Limbs that hang into the ground are lifted with their tree.
        lift = max(0.0, 0.02 - float(limbs.bounds[0, 1]))
        objects.append(placed(f"tree {len(objects) + 1}", at(limbs, position + [0, lift, 0])))
        top = max(top, float(limbs.bounds[1, 1]) + lift)
    return objects, top


def _bench(rng: np.random.Generator, plan: Plan, middle: np.ndarray) -> Shape:
    place = plan.place(rng, 1.4, 0.7, middle[[0, 2]] - 1.8, middle[[0, 2]] + [1.8, 0.8])
    if place is None:
        place = np.array([0, 0, -plan.depth / 2 + 0.4])
    return at(bench(1.2), place, rng.uniform(-0.3, 0.3))


def _reeds(rng: np.random.Generator, width: float) -> Shape:
    """Leaning rods in a row."""
    count = rng.integers(8, 25)
    feet = np.stack([rng.uniform(-width / 2, width / 2, count), 0 * np.ones(count)], axis=1)
    feet = np.stack([feet[:, 0], feet[:, 1], rng.uniform(-0.2, 0.2, count)], axis=1)
    lean = rng.normal(0, 0.12, (count, 3)) * [1, 0, 1]
    tops = feet + lean + rng.uniform(0.8, 1.7, (count, 1)) * [0, 1, 0]
    return bars(feet + [0, 0.02, 0], tops, rng.uniform(0.004, 0.014), 8)


def _lines(rng: np.random.Generator, width: float) -> Shape:
    """Two poles with sagging lines between them."""
    ends = np.array([[-width / 2, 0, 0], [width / 2, 0, 0]])
    heights = rng.uniform(1.0, 1.6, (rng.integers(1, 3), 1)) * [0, 1, 0]
    pennants = bool(rng.random() < 0.5)
    strung = wires(rng, ends[0] + heights, ends[1] + heights, bulbs=not pennants, pennants=pennants)
    return joined(*(outdoors.pole(end, 1.75) for end in ends), strung)


_SCREENS = (
    lambda rng, width: grille(width, rng.uniform(0.9, 1.5), rng.uniform(0.06, 0.16), 0.006),
    lambda rng, width: outdoors.trellis(width, rng.uniform(0.9, 1.5), rng.uniform(0.12, 0.25)),
    lambda rng, width: outdoors.pickets(rng, width, rng.uniform(0.14, 0.3)),
    _reeds,
    _lines,
)


def _rods(rng: np.random.Generator) -> Drawn:
    return _reeds(rng, 0.9), 1.3, 0.8


def _strung(rng: np.random.Generator) -> Drawn:
    width = rng.uniform(1.2, 2.0)
    return _lines(rng, width), width + 0.2, 0.4


def _bush(rng: np.random.Generator) -> Drawn:
    return plant(rng, rng.uniform(0.7, 1.6), int(rng.integers(60, 200))), 0.75, 0.75


def _trellis(rng: np.random.Generator) -> Drawn:
    width = rng.uniform(1.0, 1.8)
    return outdoors.trellis(width, rng.uniform(1.0, 1.7)), width + 0.2, 0.3


def _pergola(rng: np.random.Generator) -> Drawn:
    width, depth = rng.uniform([1.0, 0.9], [1.6, 1.3])
    shape = outdoors.pergola(width, depth, rng.uniform(1.3, 1.7), int(rng.integers(6, 14)))
    return shape, width + 0.5, depth + 0.6


_KINDS: tuple[Kind, ...] = (_rods, _strung, _bush, _trellis, outdoors.lantern, _pergola)
