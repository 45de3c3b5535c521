"""Random courts and gardens of 6 m to 10 m.

The seed determines size, objects, lights and cameras.
"""

from collections.abc import Callable

import numpy as np

from neural_shadows.scenes.arrangement import Arrangement, Placed, Region
from neural_shadows.scenes.pieces import outdoors
from neural_shadows.scenes.pieces.building import arcade, balustrade, column, flight, floor
from neural_shadows.scenes.pieces.fittings import crates, stool
from neural_shadows.scenes.pieces.furniture import bench, grille, plant, table, vase
from neural_shadows.scenes.pieces.plan import Drawn, Kind, Plan, free_spot, furnish
from neural_shadows.scenes.pieces.roofs import Site, draw_roofs
from neural_shadows.scenes.pieces.shapes import Shape, at, balls, box, boxes, joined, placed

BESIDE = 0.85  # least distance of lights to objects, metres: room for a light of 0.5 m


def arrange(rng: np.random.Generator) -> Arrangement:
    """A court with roofs, a bench and five kinds of pieces."""
    width, depth = rng.uniform([6.0, 5.2], [9.6, 7.6])
    plan = Plan(width - 0.7, depth - 0.7)
    middle = np.array([rng.uniform(-0.1, 0.1) * width, 0, rng.uniform(-0.14, -0.02) * depth])
    cameras = _cameras(rng, width, depth, middle)
    plan.take(
        cameras.low[[0, 2]] - [0.2, 0.8], cameras.high[[0, 2]] + 0.2
    )  # free space in front of cameras

    objects = [placed("ground", floor(width, depth)), *_edges(rng, width, depth)]
    seat = plan.place(rng, 1.7, 0.7, *_about(middle, 1.0))
    seat = middle if seat is None else seat
    objects.append(placed("bench", at(bench(1.5), seat, rng.uniform(-0.2, 0.2))))
    sides, about = np.array([1, 0.75, 0.5]), _about(middle, 2.0)
    spots = tuple(free_spot(rng, plan, side * sides, *about) for side in (1.0, 0.8))
    roofs, top = draw_roofs(rng, Site(plan, middle, cameras.low[2] - 0.95))
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
    """Corners (x, z) of a square about a point."""
    return middle[[0, 2]] - reach, middle[[0, 2]] + reach


def _cameras(rng: np.random.Generator, width: float, depth: float, middle: np.ndarray) -> Region:
    """Eyes in a strip along x at +z, of random height."""
    half = rng.uniform(1.0, 1.7)
    x = rng.uniform(-1, 1) * max(0.0, width / 2 - 0.7 - half)
    near = min(middle[2] + rng.uniform(1.7, 2.5), depth / 2 - 1.0)
    low = rng.uniform(1.1, 1.9)
    return Region(np.array([x - half, low, near]), np.array([x + half, low + 0.7, near + 0.7]))


def _lights(rng: np.random.Generator, middle: np.ndarray, top: float) -> Region:
    """Lights above the roofs, beside the targets."""
    half = rng.uniform([0.5, 0.1, 0.4], [1.2, 0.4, 1.0])
    centre = middle + rng.uniform([-0.9, 0, -0.6], [0.9, 0, 0.9])
    centre[1] = top + BESIDE + rng.uniform(0.05, 0.9) + half[1]
    return Region(centre - half, centre + half)


def _edges(rng: np.random.Generator, width: float, depth: float) -> list[Placed]:
    """Edges at the back and two sides, of different kinds."""
    kinds = rng.permutation(len(EDGES))
    rows = [(width, (0, 0, -depth / 2 + 0.1), 0.0)]
    rows += [
        (depth, (-width / 2 + 0.1, 0, 0), np.pi / 2),
        (depth, (width / 2 - 0.1, 0, 0), -np.pi / 2),
    ]
    return [
        placed(f"edge {k + 1}", at(EDGES[kind](rng, long - 0.3), position, turn))
        for k, (kind, (long, position, turn)) in enumerate(zip(kinds, rows))
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


def _ground(rng: np.random.Generator, plan: Plan, width: float, depth: float) -> list[Placed]:
    """Paving, grass, or stones, clear of the spots."""
    choice = rng.random()
    if choice < 0.35:
        shape = outdoors.stones(rng, _path(rng, width, depth))
        return [placed("stones", shape)]
    position = plan.place(rng, 1.4, 1.4) if choice < 0.7 else None
    if position is not None:
        return [placed("grass", at(outdoors.grass(rng, 1.2, 1.2, 300), position))]
    strip = plan.place(rng, 1.6, 0.9)
    return (
        [] if strip is None else [placed("paving", at(outdoors.paving(rng, 1.6, 0.9, 0.3), strip))]
    )


def _path(rng: np.random.Generator, width: float, depth: float) -> np.ndarray:
    """A row of points along the front."""
    x = np.linspace(-width / 2 + 0.4, width / 2 - 0.4, 11)
    z = depth / 2 - 0.5 + 0.15 * np.sin(x + rng.uniform(0, 6))
    return np.stack([x, 0 * x, z], axis=1)


def _stall(rng: np.random.Generator) -> Drawn:
    width = rng.uniform(1.2, 1.9)
    return outdoors.stall(rng, width, rng.uniform(1.6, 1.85)), width + 0.4, 1.5


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
    *(_stall, outdoors.lantern, _plant, _urn, _table, crates, _fountain, _trellis, _steps, _gate),
)
