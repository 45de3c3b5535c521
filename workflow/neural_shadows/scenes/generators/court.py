"""Courts and gardens of 6 m to 10 m, wholly drawn: paving, walls, pergolas, trees, stalls, fences.

Another seed is another layout: of another size, with other objects, lit and seen from elsewhere.
"""

from collections.abc import Callable

import numpy as np

from neural_shadows.scenes.arrangement import Arrangement, Placed, Region, Spot
from neural_shadows.scenes.generators import outdoors
from neural_shadows.scenes.generators.building import arcade, balustrade, column, flight, floor
from neural_shadows.scenes.generators.fittings import crates, stool
from neural_shadows.scenes.generators.furniture import bench, grille, plant, table, vase
from neural_shadows.scenes.generators.hanging import frame_over, ring_lamp, wires
from neural_shadows.scenes.generators.plan import Drawn, Kind, Plan, furnish
from neural_shadows.scenes.generators.shapes import (
    Shape,
    at,
    balls,
    box,
    boxes,
    joined,
    placed,
    smooth,
)

BESIDE = 0.85  # metres from the light's region to all objects: a light of half a metre has room


def arrange(rng: np.random.Generator) -> Arrangement:
    """A court seen from its side at +z: roofs over its middle, a bench, and five kinds of pieces."""
    width, depth = rng.uniform([6.0, 5.2], [9.6, 7.6])
    plan = Plan(width - 0.7, depth - 0.7)
    middle = np.array([rng.uniform(-0.1, 0.1) * width, 0, rng.uniform(-0.14, -0.02) * depth])
    cameras = _cameras(rng, width, depth, middle)
    plan.take(cameras.low[[0, 2]] - 0.2, cameras.high[[0, 2]] + 0.2)

    objects = [placed("ground", floor(width, depth)), *_edges(rng, width, depth)]
    seat = plan.place(rng, 1.7, 0.7, *_about(middle, 1.0))
    seat = middle if seat is None else seat
    objects.append(placed("bench", at(bench(1.5), seat, rng.uniform(-0.2, 0.2))))
    spots = tuple(_spot(rng, plan, middle, side) for side in (1.0, 0.8))
    roofs, top = _roofs(rng, plan, middle, cameras.low[2] - 0.6)
    objects += roofs
    kinds = [KINDS[k] for k in rng.choice(len(KINDS), 5, replace=False)]
    objects += furnish(rng, plan, kinds, rng.integers(10, 17), objects)
    objects += _ground(rng, plan, width, depth)
    return Arrangement(
        "court",
        tuple(objects),
        spots,
        lights=_lights(rng, middle, top),
        cameras=cameras,
        targets=Region(middle + [-1.5, 0.0, -1.2], middle + [1.5, 0.8, 0.9]),
        mover="bench",
    )


def _about(middle: np.ndarray, reach: float) -> tuple[np.ndarray, np.ndarray]:
    """Corners (x, z) of a square about a place."""
    return middle[[0, 2]] - reach, middle[[0, 2]] + reach


def _cameras(rng: np.random.Generator, width: float, depth: float, middle: np.ndarray) -> Region:
    """Eyes in a strip along x on the side of +z, of drawn height."""
    half = rng.uniform(1.0, 1.7)
    x = rng.uniform(-1, 1) * max(0.0, width / 2 - 0.7 - half)
    near = min(middle[2] + rng.uniform(1.7, 2.5), depth / 2 - 1.0)
    low = rng.uniform(1.1, 1.9)
    return Region(np.array([x - half, low, near]), np.array([x + half, low + 0.7, near + 0.7]))


def _lights(rng: np.random.Generator, middle: np.ndarray, top: float) -> Region:
    """Over the roofs, now nearer and now farther, to a side of what is looked at."""
    half = rng.uniform([0.5, 0.1, 0.4], [1.2, 0.4, 1.0])
    centre = middle + rng.uniform([-0.9, 0, -0.6], [0.9, 0, 0.9])
    centre[1] = top + BESIDE + rng.uniform(0.05, 0.9) + half[1]
    return Region(centre - half, centre + half)


def _edges(rng: np.random.Generator, width: float, depth: float) -> list[Placed]:
    """What stands along the back and the two sides, each of its own kind, or nothing."""
    kinds = rng.permutation(len(EDGES))
    rows = [(width, (0, 0, -depth / 2 + 0.1), 0.0)]
    rows += [
        (depth, (-width / 2 + 0.1, 0, 0), np.pi / 2),
        (depth, (width / 2 - 0.1, 0, 0), -np.pi / 2),
    ]
    return [
        placed(f"edge {k + 1}", at(EDGES[kind](rng, long - 0.3), place, turn))
        for k, (kind, (long, place, turn)) in enumerate(zip(kinds, rows))
        if k == 0 or rng.random() < 0.7
    ]


def _wall(rng: np.random.Generator, width: float) -> Shape:
    """A wall with a coping and piers."""
    high, x = rng.uniform(0.7, 1.5), width / 2
    at_x = np.linspace(-x, x, max(3, round(width / 1.8)))
    piers = boxes(
        np.stack([at_x - 0.12, 0 * at_x, 0 * at_x - 0.1], 1),
        np.stack([at_x + 0.12, 0 * at_x + high + 0.15, 0 * at_x + 0.1], 1),
    )
    return joined(
        box((-x, 0, -0.06), (x, high, 0.06)), box((-x, high, -0.09), (x, high + 0.05, 0.09)), piers
    )


def _colonnade(rng: np.random.Generator, width: float) -> Shape:
    bays = max(2, int(width / rng.uniform(1.5, 2.1)))
    span, spring = width / bays, rng.uniform(1.1, 1.5)
    feet = (np.arange(bays + 1) - bays / 2) * span
    columns = [at(column(spring, 0.12), (x, 0, 0)) for x in feet]
    return joined(arcade(bays, span, spring, spring + span / 2 + 0.1, 0.26), *columns)


def _grilles(rng: np.random.Generator, width: float) -> Shape:
    count = max(2, round(width / 1.8))
    high, apart = rng.uniform(1.2, 1.7), rng.uniform(0.08, 0.12)
    middles = ((np.arange(count) + 0.5) / count - 0.5) * width
    panel = grille(width / count - 0.08, high, apart, 0.006)
    return joined(*(at(panel, (x, 0, 0)) for x in middles))


EDGES: tuple[Callable[[np.random.Generator, float], Shape], ...] = (
    _wall,
    _colonnade,
    _grilles,
    lambda rng, width: outdoors.pickets(rng, width - 0.2, rng.uniform(0.13, 0.2)),
    lambda rng, width: outdoors.trellis(width, rng.uniform(1.2, 1.8), rng.uniform(0.12, 0.2)),
    lambda rng, width: at(
        balustrade((-width / 2, 0, 0), (width / 2, 0, 0), apart=rng.uniform(0.18, 0.26)),
        (0, 0.02, 0),
    ),
)


def _spot(rng: np.random.Generator, plan: Plan, middle: np.ndarray, side: float) -> Spot:
    """A free place on the ground near the middle, as high as it is wide."""
    for own in (side, 0.75 * side, 0.5 * side):
        place = plan.place(rng, own, own, *_about(middle, 2.0))
        if place is not None:
            break
    return Spot(place, own, rng.uniform(0, 2 * np.pi))


def _roofs(
    rng: np.random.Generator, plan: Plan, middle: np.ndarray, front: float
) -> tuple[list[Placed], float]:
    """Two or three kinds of what is over the court, and the height of the highest part under light.

    Args:
        front: how far towards the cameras they may reach.
    """
    kinds = rng.permutation(len(ROOFS))[: rng.integers(2, 4)]
    objects, tops = [], [1.9]
    for kind in kinds:
        shape, top = ROOFS[kind](rng, plan, middle, front)
        if shape is not None:
            objects.append(placed(f"roof {kind + 1}", shape))
            tops.append(top)
    return objects, max(tops)


Roof = tuple[Shape | None, float]


def _stand(plan: Plan, feet: np.ndarray, half: float = 0.1) -> bool:
    """Take the places of posts (n, 3) if all are free."""
    squares = [(foot[[0, 2]] - half, foot[[0, 2]] + half) for foot in feet]
    if not all(plan.is_free(*square) for square in squares):
        return False
    for square in squares:
        plan.take(*square)
    return True


def _pergola(rng, plan: Plan, middle: np.ndarray, front: float) -> Roof:
    """A pergola over a drawn part of the court, its slats along x or z."""
    for _ in range(40):
        size = rng.uniform([1.8, 1.6], [3.2, 2.6])
        turn = rng.integers(2)
        half = (size if turn == 0 else size[::-1]) / 2
        high = min(front - half[1] - 0.3, middle[2] + 0.8)
        place = middle + [rng.uniform(-1.2, 1.2), 0, 0]
        place[2] = rng.uniform(min(middle[2] - 0.8, high), high)
        posts = place + np.array([[a, 0, b] for a in (-1, 1) for b in (-1, 1)]) * [
            half[0],
            0,
            half[1],
        ]
        if _stand(plan, posts):
            height = rng.uniform(1.9, 2.3)
            slat = (rng.uniform(0.03, 0.08), rng.uniform(0.04, 0.08))
            slats = round(size[0] / rng.uniform(0.13, 0.26))
            shape = outdoors.pergola(*size, height, slats, slat)
            return at(shape, place, turn * np.pi / 2), height + 0.1
    return None, 0.0


def _sail(rng, plan: Plan, middle: np.ndarray, front: float) -> Roof:
    """A cloth stretched between four poles of uneven height."""
    for _ in range(40):
        half = rng.uniform([0.9, 0.8], [1.6, 1.3])
        place = middle + [rng.uniform(-1.2, 1.2), 0, rng.uniform(-0.8, 0.6)]
        place[2] = min(place[2], front - half[1] - 0.2)
        signs = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
        feet = place + np.insert(signs * half, 1, 0, axis=1)
        if _stand(plan, feet):
            break
    else:
        return None, 0.0
    heights = rng.uniform(1.7, 2.3, 4)
    u, v = np.meshgrid(np.linspace(0, 1, 25), np.linspace(0, 1, 25), indexing="ij")
    weights = np.stack([(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v], axis=-1)
    corners = feet + heights[:, None] * [0, 1, 0]
    cloth = weights @ corners - 0.9 * (u * (1 - u) * v * (1 - v))[..., None] * [0, 1.6, 0]
    poles = [outdoors.pole(foot, height + 0.06) for foot, height in zip(feet, heights)]
    # Corners face down where the grid is turned; a cloth has two sides all the same.
    return joined(smooth(cloth.transpose(1, 0, 2)), *poles), float(heights.max())


def _canopy(rng, plan: Plan, middle: np.ndarray, front: float) -> Roof:
    """A tree whose crown is over the middle."""
    for _ in range(40):
        place = middle + [rng.uniform(-1.5, 1.5), 0, rng.uniform(-1.3, 0.2)]
        if _stand(plan, place[None], 0.2):
            trunk = rng.uniform(0.75, 1.0)
            shape = joined(*outdoors.tree(rng, trunk, 5, rng.uniform(0.07, 0.12)))
            return at(shape, place), float(shape.bounds[1, 1])
    return None, 0.0


def _strung(rng, plan: Plan, middle: np.ndarray, front: float) -> Roof:
    """Frames of posts and beams with wires from one to the next, lamps under them."""
    back = -plan.depth / 2 + 0.4
    for _ in range(40):
        zs = np.array([rng.uniform(back, back + 1.0), rng.uniform(middle[2], front)])
        half = rng.uniform(1.5, 2.4)
        x = np.clip(middle[0] + rng.uniform(-0.5, 0.5), -plan.width / 2 + half + 0.1, None)
        x = min(x, plan.width / 2 - half - 0.1)
        ends = np.array([[[x - half, 0, z], [x + half, 0, z]] for z in zs])
        if zs[1] - zs[0] > 1.2 and _stand(plan, ends.reshape(-1, 3)):
            break
    else:
        return None, 0.0
    height, count = rng.uniform(1.95, 2.3), rng.integers(4, 8)
    share = rng.uniform(0.05, 0.95, (2, count, 1))
    starts, stops = (
        beam[0] + own * (beam[1] - beam[0]) + [0, height - 0.04, 0]
        for beam, own in zip(ends, share)
    )
    bulbs = rng.random() < 0.5
    lamps = [
        at(
            ring_lamp(rng.uniform(0.2, 0.5), rng.uniform(0.2, 0.35)),
            end[0] + own * (end[1] - end[0]) + [0, height - 0.14, 0],
        )
        for end in ends
        for own in (rng.uniform(0.15, 0.45), rng.uniform(0.55, 0.85))
    ]
    strings = wires(rng, starts, stops, bulbs=bulbs, pennants=not bulbs)
    return joined(frame_over(ends, height), strings, *lamps), height


ROOFS = (_pergola, _sail, _canopy, _strung)


def _ground(rng: np.random.Generator, plan: Plan, width: float, depth: float) -> list[Placed]:
    """Paving, grass, or stones, clear of the spots."""
    way = rng.random()
    if way < 0.35:
        shape = outdoors.stones(rng, _path(rng, width, depth))
        return [placed("stones", shape)]
    place = plan.place(rng, 1.4, 1.4) if way < 0.7 else None
    if place is not None:
        return [placed("grass", at(outdoors.grass(rng, 1.2, 1.2, 300), place))]
    strip = plan.place(rng, 1.6, 0.9)
    return (
        [] if strip is None else [placed("paving", at(outdoors.paving(rng, 1.6, 0.9, 0.3), strip))]
    )


def _path(rng: np.random.Generator, width: float, depth: float) -> np.ndarray:
    """A row of places along the front."""
    x = np.linspace(-width / 2 + 0.4, width / 2 - 0.4, 11)
    z = depth / 2 - 0.5 + 0.15 * np.sin(x + rng.uniform(0, 6))
    return np.stack([x, 0 * x, z], axis=1)


def _stall(rng: np.random.Generator) -> Drawn:
    width = rng.uniform(1.2, 1.9)
    return outdoors.stall(rng, width, rng.uniform(1.6, 1.85)), width + 0.4, 1.5


def _lantern(rng: np.random.Generator) -> Drawn:
    arm = rng.uniform(0.2, 0.32)
    return outdoors.lantern(rng.uniform(1.4, 1.8), arm), 2 * arm + 0.3, 0.4


def _plant(rng: np.random.Generator) -> Drawn:
    return plant(rng, rng.uniform(0.8, 1.6), 120), 0.75, 0.75


def _urn(rng: np.random.Generator) -> Drawn:
    high, half = rng.uniform(0.3, 0.8), rng.uniform(0.18, 0.28)
    block = joined(
        box((-half, 0, -half), (half, high - 0.05, half)),
        box((-half - 0.04, high - 0.05, -half - 0.04), (half + 0.04, high, half + 0.04)),
    )
    top = vase(rng.uniform(0.4, 0.7)) if rng.random() < 0.6 else balls([[0, half, 0]], half, 3)
    return joined(block, at(top, (0, high, 0))), 2 * half + 0.2, 2 * half + 0.2


def _table(rng: np.random.Generator) -> Drawn:
    width = rng.uniform(1.0, 1.5)
    seats = [at(stool(0.48), (x, 0, z)) for x in (-0.3, 0.3) for z in (-0.62, 0.62)]
    return joined(table(width, 0.7, 0.74), *seats), width + 0.15, 1.7


def _crates(rng: np.random.Generator) -> Drawn:
    return crates(rng, rng.integers(2, 6)), 0.75, 0.6


def _fountain(rng: np.random.Generator) -> Drawn:
    radius = rng.uniform(0.5, 0.75)
    return outdoors.fountain(radius), 2.2 * radius, 2.2 * radius


def _trellis(rng: np.random.Generator) -> Drawn:
    width = rng.uniform(1.0, 1.7)
    return outdoors.trellis(width, rng.uniform(1.2, 1.7)), width + 0.2, 0.3


def _steps(rng: np.random.Generator) -> Drawn:
    steps, width = rng.integers(3, 6), rng.uniform(0.9, 1.3)
    run, high, end = 0.28 * steps, 0.17 * steps, 0.3 + 0.14 * steps
    landing = box((run - end, 0, -width / 2), (end, high, width / 2))
    return joined(at(flight(steps, width), (-end, 0, 0)), landing), 2 * end + 0.1, width + 0.1


def _gate(rng: np.random.Generator) -> Drawn:
    """Two columns with an arch."""
    span, spring = rng.uniform(1.3, 1.7), rng.uniform(0.9, 1.2)
    sides = [at(column(spring, 0.12), (x, 0, 0)) for x in (-span / 2, span / 2)]
    return joined(arcade(1, span, spring, spring + span / 2, 0.26), *sides), span + 0.4, 0.5


KINDS: tuple[Kind, ...] = (
    *(_stall, _lantern, _plant, _urn, _table, _crates, _fountain, _trellis, _steps, _gate),
)
