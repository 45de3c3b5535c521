"""Random rooms of 5 m to 9 m.

The seed determines size, walls, furniture, hanging objects, lights and cameras.
"""

import numpy as np

from neural_shadows.scenes.arrangement import Arrangement, Placed, Region, Spot
from neural_shadows.scenes.pieces import fittings
from neural_shadows.scenes.pieces.building import arcade, column, floor, window_wall
from neural_shadows.scenes.pieces.furniture import (
    bench,
    books,
    chair,
    grille,
    plant,
    shelf,
    table,
    vase,
)
from neural_shadows.scenes.pieces.hanging import (
    banner,
    basket,
    frame_over,
    mobile,
    ring_lamp,
    shade_lamp,
    wires,
)
from neural_shadows.scenes.pieces.plan import Drawn, Kind, Plan, free_spot, furnish
from neural_shadows.scenes.pieces.shapes import Shape, at, beams, box, boxes, joined, placed

TABLE = 0.75
BESIDE = 0.85  # least distance of lights to objects, metres: room for a light of 0.5 m
WALL = 0.1


def arrange(rng: np.random.Generator) -> Arrangement:
    """A room with a table, furniture and hanging objects."""
    width, depth = rng.uniform([5.0, 4.6], [8.6, 6.4])
    plan = Plan(width - 0.2, depth - 0.2)
    hung = rng.uniform(1.95, 2.45)  # height of the beams' tops
    middle = np.array([rng.uniform(-0.1, 0.1) * width, 0, rng.uniform(-0.12, 0.0) * depth])
    cameras = _cameras(rng, width, depth, middle)
    plan.take(
        cameras.low[[0, 2]] - [0.15, 0.5], cameras.high[[0, 2]] + 0.15
    )  # free space in front of cameras
    lights = _lights(rng, middle, hung)

    objects = [placed("floor", floor(width, depth)), *_walls(rng, width, depth)]
    posts = _beams(rng, plan, width, cameras.low[2] - 0.65)
    objects.append(placed("beams", frame_over(posts, hung)))
    laid, table_spot = _laid_table(rng, plan, middle)
    objects += laid
    about = middle[[0, 2]] + [-1.9, -1.4], middle[[0, 2]] + [1.9, 1.2]
    spot = free_spot(rng, plan, (1.0, 0.8, 0.6, 0.45), *about)
    kinds = [KINDS[k] for k in rng.choice(len(KINDS), 6, replace=False)]
    objects += furnish(rng, plan, kinds, rng.integers(14, 22), objects)
    objects += _hanging(rng, plan, posts, hung)
    return Arrangement(
        "interior",
        tuple(objects),
        (table_spot, spot),
        lights=lights,
        cameras=cameras,
        targets=Region(middle + [-1.2, 0.1, -1.0], middle + [1.2, 0.8, 0.8]),
        mover="chair 1",
    )


def _cameras(rng: np.random.Generator, width: float, depth: float, middle: np.ndarray) -> Region:
    """Eyes in a strip along x at +z, of random height."""
    half = rng.uniform(0.9, 1.5)
    x = rng.uniform(-1, 1) * max(0.0, width / 2 - 0.5 - half)
    near = min(middle[2] + rng.uniform(1.5, 2.2), depth / 2 - 0.9)
    low = rng.uniform(1.2, 1.9)
    return Region(np.array([x - half, low, near]), np.array([x + half, low + 0.7, near + 0.6]))


def _lights(rng: np.random.Generator, middle: np.ndarray, hung: float) -> Region:
    """Lights above the beams, beside the targets."""
    half = rng.uniform([0.5, 0.1, 0.4], [1.1, 0.35, 0.9])
    centre = middle + rng.uniform([-0.8, 0, -0.5], [0.8, 0, 0.8])
    centre[1] = hung + BESIDE + rng.uniform(0.05, 0.8) + half[1]
    return Region(centre - half, centre + half)


def _walls(rng: np.random.Generator, width: float, depth: float) -> list[Placed]:
    """Walls at the back and the sides, of different kinds."""
    kinds = rng.permutation(len(WALLS))
    back = WALLS[kinds[0]](rng, width)
    walls = [placed("back wall", at(back, (0, 0, -depth / 2)))]
    sides = [(-width / 2, np.pi / 2), (width / 2, -np.pi / 2)]
    for k, (x, turn) in enumerate(sides):
        if rng.random() < 0.75:
            walls.append(
                placed(f"side wall {k + 1}", at(WALLS[kinds[1 + k]](rng, depth), (x, 0, 0), turn))
            )
    return walls


def _windows(rng: np.random.Generator, width: float) -> Shape:
    count = max(2, round(width / rng.uniform(1.3, 2.2)))
    sill = rng.uniform(0.3, 0.9)
    opening = 0.7 * width / count
    return window_wall(width, sill + 1.5, count, sill=sill, top=sill + 1.25, opening=opening)


def _plain(rng: np.random.Generator, width: float) -> Shape:
    """A wall with a ledge and a skirting."""
    high = rng.uniform(1.0, 1.9)
    x = width / 2
    return joined(
        box((-x, 0, -WALL), (x, high, 0)),
        box((-x, 0, 0), (x, 0.09, 0.02)),
        box((-x, high - 0.3, 0), (x, high - 0.26, rng.uniform(0.05, 0.1))),
    )


def _arches(rng: np.random.Generator, width: float) -> Shape:
    """Columns with arches over them, and a low wall between."""
    bays = max(2, int(width / rng.uniform(1.4, 2.0)))
    span, spring = width / bays, rng.uniform(1.1, 1.5)
    feet = (np.arange(bays + 1) - bays / 2) * span
    feet = np.clip(feet, -width / 2 + 0.2, width / 2 - 0.2)
    arches = arcade(bays, span, spring, spring + span / 2 + 0.1, 0.3)
    columns = [at(column(spring, 0.13), (x, 0, -0.2)) for x in feet]
    return joined(at(arches, (0, 0, -0.2)), *columns)


def _slats(rng: np.random.Generator, width: float) -> Shape:
    """A screen of upright slats between two rails."""
    high, apart = rng.uniform(1.3, 2.0), rng.uniform(0.1, 0.2)
    x = np.arange(-width / 2 + 0.05, width / 2 - 0.03, apart)
    feet = np.stack([x, np.full_like(x, 0.06), np.full_like(x, -0.05)], axis=1)
    rails = np.array([[-width / 2, y, -0.05] for y in (0.03, high)])
    return joined(
        beams(feet, feet + [0, high - 0.06, 0], 0.05, 0.03),
        beams(rails, rails * [-1, 1, 1], 0.07, 0.06),
    )


WALLS = (_windows, _plain, _arches, _slats)


def _beams(rng: np.random.Generator, plan: Plan, width: float, front: float) -> np.ndarray:
    """Ends (n, 2, 3) of two to four beams along x, behind `front`."""
    count = rng.integers(2, 5)
    back = -plan.depth / 2 + 0.3
    zs = np.linspace(back, front, count + 1)[:-1] + rng.uniform(0.1, 0.9) * (front - back) / count
    x = width / 2 - 0.15
    ends = np.array([[[-x, 0, z], [x, 0, z]] for z in zs])
    for foot in ends.reshape(-1, 3)[:, [0, 2]]:
        plan.take(foot - 0.1, foot + 0.1)
    return ends


def _laid_table(
    rng: np.random.Generator, plan: Plan, middle: np.ndarray
) -> tuple[list[Placed], Spot]:
    """A table with chairs and an object, and a spot on it."""
    if rng.random() < 0.35:
        radius = rng.uniform(0.55, 0.8)
        top, half = fittings.round_table(radius, TABLE), np.array([radius, radius])
        angles = rng.uniform(0, 2 * np.pi) + np.arange(rng.integers(3, 5)) * 1.6
        seats = [
            (np.sin(a) * (radius + 0.15), np.cos(a) * (radius + 0.15), a + np.pi) for a in angles
        ]
    else:
        half = rng.uniform([0.65, 0.4], [1.1, 0.55])
        top = table(2 * half[0], 2 * half[1], TABLE)
        x = np.linspace(-half[0] + 0.35, half[0] - 0.35, 1 if half[0] < 0.75 else 2)
        seats = [(c, half[1] + 0.12, np.pi) for c in x] + [(c, -half[1] - 0.12, 0.0) for c in x]
        seats += [(half[0] + 0.15, 0, -np.pi / 2)] * (rng.random() < 0.6)
    reach = half + 0.62
    low, high = middle[[0, 2]] + [-1.0, -1.1], middle[[0, 2]] + [1.0, 0.5]
    position = plan.place(rng, *(2 * reach), low, high, top=1.05)
    if position is None:
        position = middle
        plan.take(middle[[0, 2]] - reach, middle[[0, 2]] + reach, top=1.05)
    parts = [placed("table", at(top, position))]
    for k, (x, z, turn) in enumerate(seats):
        back = rng.uniform(0, 0.22) * np.array([np.sin(turn), 0, np.cos(turn)])
        seat = at(chair(), position + [x, 0, z] - back, turn + rng.uniform(-0.25, 0.25))
        parts.append(placed(f"chair {k + 1}", seat))
    beside = position + [rng.choice([-1, 1]) * (half[0] - 0.16), TABLE, rng.uniform(-0.1, 0.1)]
    on_it = vase(rng.uniform(0.2, 0.34)) if rng.random() < 0.5 else books(rng, 0.26, 0.27)
    parts.append(placed("on the table", at(on_it, beside)))
    return parts, Spot(position + [0, TABLE, 0], 0.5, rng.uniform(0, 2 * np.pi))


def _shelf(rng: np.random.Generator) -> Drawn:
    width = rng.uniform(0.8, 1.5)
    return shelf(rng, width, rng.uniform(1.1, 1.8), rng.integers(3, 6)), width + 0.1, 0.42


def _rack(rng: np.random.Generator) -> Drawn:
    width = rng.uniform(0.8, 1.4)
    return fittings.rack(rng, width, rng.uniform(1.2, 1.8)), width + 0.1, 0.54


def _grille(rng: np.random.Generator) -> Drawn:
    width = rng.uniform(0.8, 1.4)
    shape = grille(width, rng.uniform(1.0, 1.6), rng.uniform(0.05, 0.1), 0.006)
    return at(shape, (0, 0, -0.09)), width + 0.12, 0.5


def _desk(rng: np.random.Generator) -> Drawn:
    width = rng.uniform(1.0, 1.4)
    on_it = at(books(rng, 0.4, 0.3), (rng.uniform(-0.25, 0.25), 0.74, -0.1))
    seat = at(chair(5), (rng.uniform(-0.15, 0.15), 0, 0.42), np.pi + rng.uniform(-0.4, 0.4))
    whole = joined(table(width, 0.6, 0.74), on_it, seat)
    return at(whole, (0, 0, -0.2)), width + 0.1, 1.15


def _plant(rng: np.random.Generator) -> Drawn:
    return plant(rng, rng.uniform(0.9, 1.7), 130), 0.75, 0.75


def _column(rng: np.random.Generator) -> Drawn:
    radius = rng.uniform(0.1, 0.18)
    return column(rng.uniform(1.2, 1.9), radius), 3.2 * radius, 3.2 * radius


def _rail(rng: np.random.Generator) -> Drawn:
    width = rng.uniform(0.9, 1.5)
    return fittings.cloth_rail(rng, width, rng.uniform(1.35, 1.65)), width + 0.1, 0.6


def _lamp(rng: np.random.Generator) -> Drawn:
    return fittings.floor_lamp(rng.uniform(1.3, 1.75)), 0.5, 0.5


def _podium(rng: np.random.Generator) -> Drawn:
    steps, width, length = rng.integers(2, 5), rng.uniform(0.8, 1.1), rng.uniform(0.7, 1.1)
    long = steps * fittings.GOING + length + 0.1
    return fittings.podium(steps, width, length), long, width + 0.1


def _easel(rng: np.random.Generator) -> Drawn:
    return fittings.easel(rng.uniform(1.3, 1.7), rng.uniform(0.6, 0.95)), 1.05, 0.95


def _stools(rng: np.random.Generator) -> Drawn:
    spread = [(-0.3, 0.0), (0.32, 0.1), (0.0, -0.4)][: rng.integers(1, 4)]
    return joined(*(at(fittings.stool(), (x, 0, z)) for x, z in spread)), 1.15, 1.15


def _bench(rng: np.random.Generator) -> Drawn:
    width = rng.uniform(1.0, 1.6)
    return bench(width), width + 0.1, 0.6


def _plinth(rng: np.random.Generator) -> Drawn:
    high, half = rng.uniform(0.5, 1.0), rng.uniform(0.16, 0.24)
    block = boxes([[-half, 0, -half]], [[half, high, half]])
    return (
        joined(block, at(vase(rng.uniform(0.35, 0.6)), (0, high, 0))),
        2 * half + 0.1,
        2 * half + 0.1,
    )


KINDS: tuple[Kind, ...] = (
    *(_shelf, _rack, _grille, _desk, _plant, _column, fittings.crates),
    *(_rail, _lamp, _podium, _easel, _stools, _bench, _plinth),
)


def _hanging(rng: np.random.Generator, plan: Plan, ends: np.ndarray, hung: float) -> list[Placed]:
    """Lamps, cloths and mobiles under beams, slats or wires above."""
    kinds = rng.permutation(len(HANGING))
    under, parts = hung - 0.14, []
    for number, (start, end) in enumerate(ends):
        draw, apart = HANGING[kinds[number % len(kinds)]]
        count = max(2, int((end[0] - start[0]) / apart))
        share = (np.arange(count) + rng.uniform(0.2, 0.8, count)) / count
        pieces = []
        for position in start + share[:, None] * (end - start) + [0, under, 0]:
            piece = at(draw(rng), position)
            low, high = piece.bounds
            if plan.is_under(low[[0, 2]], high[[0, 2]], low[1] - 0.05):
                pieces.append(piece)
        if pieces:
            parts.append(placed(f"under beam {number + 1}", *pieces))
    first, last = ends[0], ends[-1]
    choice = rng.random()
    if choice < 0.4:  # slats from the first beam to the last, over a part of the room
        long = first[1, 0] - first[0, 0]
        x = first[0, 0] + long * rng.uniform(0.03, 0.4)
        xs = np.arange(x, x + long * rng.uniform(0.3, 0.55), rng.uniform(0.14, 0.3))
        starts, stops = (
            np.stack([xs, 0 * xs + hung - 0.02, 0 * xs + beam[0, 2] + out], axis=1)
            for beam, out in ((first, -0.2), (last, 0.2))
        )
        parts.append(placed("slats", beams(starts, stops, rng.uniform(0.04, 0.09), 0.04)))
    elif choice < 0.8:
        share = rng.uniform(0.05, 0.95, (2, rng.integers(3, 6), 1))
        starts, stops = (
            beam[0] + own * (beam[1] - beam[0]) + [0, hung - 0.04, 0]
            for beam, own in zip((first, last), share)
        )
        bulbs = rng.random() < 0.5
        parts.append(placed("wires", wires(rng, starts, stops, bulbs=bulbs, pennants=not bulbs)))
    return parts


HANGING = (
    (lambda rng: ring_lamp(rng.uniform(0.2, 0.6), rng.uniform(0.22, 0.42)), 1.6),
    (lambda rng: shade_lamp(rng.uniform(0.15, 0.5), rng.uniform(0.15, 0.3)), 1.3),
    (lambda rng: basket(rng.uniform(0.1, 0.4), rng.uniform(0.15, 0.26)), 1.2),
    (lambda rng: banner(rng, rng.uniform(0.35, 0.7), rng.uniform(0.4, 0.8)), 1.6),
    (lambda rng: mobile(rng, rng.uniform(0.1, 0.3)), 1.8),
)
