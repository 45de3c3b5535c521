"""Random halls of 6 m to 9 m of thick walls and many objects, lit from among them.

The seed determines size, objects, lights and cameras. Lights hang lower than the tops of what stands
round them, so that penumbrae are wide; a light has room for a radius of 0.1 m.
"""

import numpy as np

from neural_shadows.scenes.arrangement import Arrangement, Placed, Region
from neural_shadows.scenes.generators.interior import KINDS
from neural_shadows.scenes.pieces.building import arcade, column, floor
from neural_shadows.scenes.pieces.furniture import chair
from neural_shadows.scenes.pieces.plan import Drawn, Kind, Plan, free_spot, furnish
from neural_shadows.scenes.pieces.shapes import Shape, at, beams, box, boxes, joined, placed

_BESIDE = 0.45  # least distance of lights to objects, metres


def arrange(rng: np.random.Generator) -> Arrangement:
    """Walls with openings about a court of light, furniture on both sides of them."""
    width, depth = rng.uniform([6.0, 5.2], [9.0, 7.2])
    plan = Plan(width - 0.3, depth - 0.3)
    middle = np.array([rng.uniform(-0.08, 0.08) * width, 0, rng.uniform(-0.12, -0.02) * depth])
    half, low = rng.uniform(0.8, 1.4), rng.uniform(1.2, 1.8)
    near = min(middle[2] + rng.uniform(1.7, 2.3), depth / 2 - 0.9)
    x = middle[0] + rng.uniform(-0.4, 0.4)
    cameras = Region(np.array([x - half, low, near]), np.array([x + half, low + 0.6, near + 0.5]))
    plan.take(cameras.low[[0, 2]] - [0.15, 0.5], cameras.high[[0, 2]] + 0.15)
    lights = _lights(rng, plan, middle)

    objects = [placed("floor", floor(width, depth))]
    about = middle[[0, 2]] - 2.4, middle[[0, 2]] + 2.2
    sides = np.array([1, 0.75, 0.5, 0.4])
    spot = free_spot(rng, plan, 0.8 * sides, *about)
    seat = plan.place(rng, 0.7, 0.7, middle[[0, 2]] - 1.8, middle[[0, 2]] + [1.8, 1.0])
    seat = np.array([-plan.width / 2 + 0.4, 0, 0]) if seat is None else seat
    objects.append(placed("chair", at(chair(), seat, rng.uniform(0, 2 * np.pi))))
    for number in range(rng.integers(2, 5)):
        wall = _inner_wall(rng, plan, middle)
        if wall is not None:
            objects.append(placed(f"wall {number + 1}", wall))
    other = free_spot(rng, plan, 0.6 * sides, *about)
    kinds = [_KINDS[k] for k in rng.choice(len(_KINDS), 6, replace=False)]
    objects += furnish(rng, plan, kinds, rng.integers(16, 26), objects)
    objects += _outer_walls(rng, width, depth)
    return Arrangement(
        "passage",
        tuple(objects),
        (spot, other),
        lights=lights,
        cameras=cameras,
        targets=Region(middle + [-1.5, 0.0, -1.4], middle + [1.5, 1.0, 0.6]),
        mover="chair",
    )


def _lights(rng: np.random.Generator, plan: Plan, middle: np.ndarray) -> Region:
    """Lights over a free rectangle of the floor, within reach of what stands round it."""
    half = rng.uniform([0.1, 0.1, 0.1], [0.35, 0.3, 0.3])
    centre = middle + rng.uniform([-1.2, 0, -1.0], [1.2, 0, 0.4])
    plan.take(centre[[0, 2]] - half[[0, 2]] - _BESIDE, centre[[0, 2]] + half[[0, 2]] + _BESIDE)
    centre[1] = rng.uniform(1.3, 2.4) + half[1]
    return Region(centre - half, centre + half)


def _inner_wall(rng: np.random.Generator, plan: Plan, middle: np.ndarray) -> Shape | None:
    """A thick wall with an opening, an arch or a window, along x or z."""
    long, thick = rng.uniform(1.2, 2.6), rng.uniform(0.12, 0.5)
    turned = rng.random() < 0.5
    size = (thick + 0.1, long) if turned else (long, thick + 0.1)
    place = plan.place(rng, *size, middle[[0, 2]] - 2.6, middle[[0, 2]] + [2.6, 1.2])
    if place is None:
        return None
    shape = _WALLS[rng.integers(len(_WALLS))](rng, long, thick)
    return at(shape, place, np.pi / 2 if turned else 0.0)


def _plain(rng: np.random.Generator, long: float, thick: float) -> Shape:
    high = rng.uniform(0.8, 2.4)
    return box((-long / 2, 0, -thick / 2), (long / 2, high, thick / 2))


def _pierced(rng: np.random.Generator, long: float, thick: float) -> Shape:
    """A wall with holes in rows."""
    rows, columns = rng.integers(2, 5), rng.integers(3, 7)
    high, share = rng.uniform(1.4, 2.4), rng.uniform(0.3, 0.65)  # of the holes
    y, x = high / rows, long / columns
    z = thick / 2
    levels = [box((-long / 2, 0, -z), (long / 2, 0.06, z))]
    for row in range(rows):
        low, top = 0.06 + row * y, 0.06 + (row + 1) * y
        bar = top - (1 - share) * y
        levels.append(box((-long / 2, bar, -z), (long / 2, top, z)))
        at_x = np.linspace(-long / 2, long / 2, columns + 1)
        side = (1 - share) * x / 2
        lows = [[max(c - side, -long / 2), low, -z] for c in at_x]
        highs = [[min(c + side, long / 2), bar, z] for c in at_x]
        levels.append(boxes(lows, highs))
    return joined(*levels)


def _arched(rng: np.random.Generator, long: float, thick: float) -> Shape:
    bays = max(1, int(long / 1.1))
    span, spring = long / bays, rng.uniform(1.0, 1.4)
    feet = (np.arange(bays + 1) - bays / 2) * span
    feet = np.clip(feet, -long / 2 + 0.1, long / 2 - 0.1)
    piers = boxes(
        [[c - 0.1, 0, -thick / 2] for c in feet], [[c + 0.1, spring, thick / 2] for c in feet]
    )
    return joined(arcade(bays, span, spring, spring + span / 2 + 0.1, thick), piers)


def _slatted(rng: np.random.Generator, long: float, thick: float) -> Shape:
    """Deep upright slats between two rails."""
    xs = np.arange(-long / 2 + 0.05, long / 2, rng.uniform(0.1, 0.25))
    feet = np.stack([xs, np.full_like(xs, 0.06), 0 * xs], axis=1)
    high = rng.uniform(1.2, 2.2)
    rails = np.array([[-long / 2, y, 0] for y in (0.03, high)])
    return joined(
        beams(feet, feet + [0, high - 0.06, 0], 0.03, thick),
        beams(rails, rails * [-1, 1, 1], thick, 0.06),
    )


_WALLS = (_plain, _pierced, _arched, _slatted)


def _outer_walls(rng: np.random.Generator, width: float, depth: float) -> list[Placed]:
    """Walls at the back and at one or two sides."""
    high, thick = rng.uniform(1.6, 3.0), 0.2
    parts = [box((-width / 2, 0, -depth / 2 - thick), (width / 2, high, -depth / 2))]
    for side in (-1, 1):
        if rng.random() < 0.7:
            a, b = sorted((side * width / 2, side * (width / 2 + thick)))
            parts.append(box((a, 0, -depth / 2), (b, high, depth / 2)))
    return [placed("outer walls", *parts)]


def _pillar(rng: np.random.Generator) -> Drawn:
    if rng.random() < 0.5:
        radius = rng.uniform(0.08, 0.16)
        return column(rng.uniform(1.4, 2.4), radius), 3.2 * radius, 3.2 * radius
    half = rng.uniform(0.06, 0.25)
    block = box((-half, 0, -half), (half, rng.uniform(0.5, 2.4), half))
    return block, 2 * half + 0.05, 2 * half + 0.05


_KINDS: tuple[Kind, ...] = (*KINDS, _pillar, _pillar, _pillar)
