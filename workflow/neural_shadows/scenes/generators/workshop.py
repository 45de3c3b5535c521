"""Workshop of 6 m × 5 m with many thin parts."""

import numpy as np
import trimesh

from neural_shadows.scenes.arrangement import Arrangement, Region, Spot
from neural_shadows.scenes.pieces.building import floor, walls
from neural_shadows.scenes.pieces.furniture import grille, table
from neural_shadows.scenes.pieces.shapes import (
    Shape,
    at,
    balls,
    bars,
    beams,
    box,
    boxes,
    joined,
    placed,
    ring,
)

BENCH = 0.9
WALL = 2.4


def arrange(rng: np.random.Generator) -> Arrangement:
    """A workbench, tools, racks, a ladder, a wheel and wires."""
    objects = (
        placed("floor", floor(6, 5)),
        placed("walls", walls(6, 5, WALL)),
        placed("workbench", at(table(2.4, 0.8, BENCH, 0.04), (-0.3, 0, -1.9))),
        placed("tools", at(_tools(rng), (-0.3, 1.15, -2.5))),
        placed("rack 1", at(_rack(rng), (-2.65, 0, 0.2), np.pi / 2)),
        placed("rack 2", at(_rack(rng), (2.65, 0, -0.8), -np.pi / 2)),
        placed("ladder", at(_ladder(), (2.0, 0, 1.7), rng.uniform(0.6, 1.0))),
        placed("wheel", at(_wheel(), (0.9, 0, rng.uniform(0.0, 0.4)), rng.uniform(-0.4, 0.8))),
        placed("sawhorses", at(_sawhorses(), (-0.9, 0, rng.uniform(0.6, 0.9)))),
        placed("grille", at(grille(1.2, 1.2, 0.05), (-1.7, 0, -1.1 + rng.uniform(0, 0.1)), 0.5)),
        placed("wires", _wires(rng)),
        placed("boxes on the bench", at(_small_boxes(rng), (-1.1, BENCH, -1.9))),
    )
    spots = (
        Spot(np.array([0.35, BENCH, -1.85]), 0.5, rng.uniform(0, 2 * np.pi)),
        Spot(np.array([1.9, 0.0, 0.5]), 0.7, rng.uniform(0, 2 * np.pi)),
    )
    return Arrangement(
        "workshop",
        objects,
        spots,
        lights=Region(np.array([-0.9, 2.85, -0.9]), np.array([0.9, 3.8, 0.9])),
        cameras=Region(np.array([-2.1, 1.2, -0.6]), np.array([2.2, 2.0, 2.3])),
        targets=Region(np.array([-1.4, 0.2, -2.0]), np.array([1.4, 1.2, 0.6])),
        mover="wheel",
    )


def _tools(rng: np.random.Generator) -> Shape:
    """A pegboard facing +z with hammers, blades, rings, rods."""
    x, y = np.meshgrid(np.linspace(-1.1, 1.1, 23), np.linspace(0.1, 1.0, 10), indexing="ij")
    pegs = np.stack([x, y, np.full_like(x, 0.02)], axis=-1).reshape(-1, 3)
    parts = [box((-1.2, 0, 0), (1.2, 1.1, 0.02)), bars(pegs, pegs + [0, 0, 0.05], 0.004, 6)]
    for x in np.linspace(-1.0, 1.0, 11) + rng.uniform(-0.04, 0.04, 11):
        top, long, kind = rng.uniform(0.75, 0.95), rng.uniform(0.25, 0.6), rng.integers(3)
        parts.append(bars([[x, top - long, 0.05]], [[x, top, 0.05]], 0.012, 12))
        if kind == 0:
            parts.append(box((x - 0.07, top, 0.03), (x + 0.07, top + 0.04, 0.07)))
        elif kind == 1:
            parts.append(box((x - 0.045, top - long, 0.045), (x + 0.045, top - 0.15, 0.049)))
        else:
            upright = trimesh.transformations.rotation_matrix(np.pi / 2, [1, 0, 0])
            parts.append(at(ring(0.06, 0.008).apply_transform(upright), (x, top + 0.06, 0.05)))
    return joined(*parts)


def _rack(rng: np.random.Generator) -> Shape:
    """A rack of wire shelves facing +z, with tins and rods."""
    x, z, ys = 0.8, 0.22, np.array([0.15, 0.65, 1.15, 1.65])
    posts = np.array([[a, 0, b] for a in (-x, x) for b in (-z, z)])
    parts = [bars(posts, posts + [0, 1.8, 0], 0.012, 12)]
    wires = np.linspace(-x, x, 33)[:, None] * [1, 0, 0]
    edges = np.array([[-x, 0, -z], [x, 0, -z], [x, 0, z], [-x, 0, z]])
    for y in ys:
        level = [0, y, 0]
        parts.append(bars(wires + level - [0, 0, z], wires + level + [0, 0, z], 0.003, 6))
        parts.append(bars(edges + level, np.roll(edges, -1, axis=0) + level, 0.006, 8))
        at_x = np.arange(-0.6, 0.7, 0.3) + rng.uniform(-0.05, 0.05, 5)
        feet = np.stack([at_x, np.full(5, y + 0.006), rng.uniform(-0.08, 0.08, 5)], axis=1)[
            rng.random(5) < 0.6
        ]
        if len(feet):
            high = rng.uniform(0.1, 0.3, (len(feet), 1)) * [0, 1, 0]
            parts.append(bars(feet, feet + high, rng.uniform(0.04, 0.09, len(feet)), 20))
    return joined(*parts)


def _ladder() -> Shape:
    """A stepladder, open along z."""
    parts, top = [], np.array([0, 1.7, 0])
    for z in (-0.5, 0.5):
        for x in (-0.22, 0.22):
            parts.append(beams([[x, 0.02, z]], [top + [0.8 * x, 0, 0.04 * z]], 0.03, 0.03))
        share = np.linspace(0.14, 0.95, 6)[:, None]
        line = (1 - share) * [0, 0.02, z] + share * (top + [0, 0, 0.04 * z])
        half = (1 - 0.2 * share) * [0.22, 0, 0]
        parts.append(bars(line - half, line + half, 0.012, 12))
    feet = np.array([[x, 0, z] for x in (-0.22, 0.22) for z in (-0.5, 0.5)])
    parts.append(boxes(feet - [0.025, 0, 0.03], feet + [0.025, 0.04, 0.03]))
    return joined(*parts, box((-0.2, 1.68, -0.06), (0.2, 1.72, 0.06)))


def _wheel() -> Shape:
    """A spoked wheel, upright across x, on a stand."""
    upright = trimesh.transformations.rotation_matrix(np.pi / 2, [0, 0, 1])
    angle = 2 * np.pi * np.arange(32) / 32
    rim = np.stack([np.zeros(32), np.cos(angle), np.sin(angle)], axis=1) * 0.33
    side = np.where(np.arange(32) % 2, 0.035, -0.035)[:, None] * [1, 0, 0]
    hub = np.array([0, 0.75, 0])
    wheel = joined(
        ring(0.34, 0.016).apply_transform(upright),
        bars(side + 0.06 * rim, rim, 0.0015, 6),
        bars([[-0.08, 0, 0]], [[0.08, 0, 0]], 0.022, 16),
    )
    legs = np.array([[x, 0, z] for x in (-0.08, 0.08) for z in (-0.3, 0.3)])
    tops = legs * [1, 0, 0] + hub
    feet = boxes(legs - [0.015, 0, 0.015], legs + [0.015, 0.03, 0.015])
    return joined(at(wheel, hub), bars(legs + [0, 0.012, 0], tops, 0.01, 10), feet)


def _sawhorses() -> Shape:
    """Two trestles with a plank and rods across them."""
    parts = []
    for x in (-0.5, 0.5):
        parts.append(beams([[x, 0.62, -0.4]], [[x, 0.62, 0.4]], 0.05, 0.06))
        for z in (-0.32, 0.32):
            for out in (-0.16, 0.16):
                parts.append(beams([[x + out, 0.015, z]], [[x, 0.6, z]], 0.03, 0.03))
                parts.append(box((x + out - 0.03, 0, z - 0.02), (x + out + 0.03, 0.03, z + 0.02)))
    rods = np.linspace(0.05, 0.3, 6)[:, None] * [0, 0, 1] + [-0.9, 0.662, 0]
    parts.append(bars(rods, rods + [1.8, 0, 0], 0.012, 10))
    return joined(*parts, box((-1.0, 0.65, -0.3), (1.0, 0.68, -0.08)))


def _wires(rng: np.random.Generator) -> Shape:
    """Sagging wires from wall to wall, one with bulbs."""
    parts, t = [], np.linspace(0, 1, 33)[:, None]
    for k, x in enumerate(np.linspace(-1.9, 1.9, 6) + rng.uniform(-0.2, 0.2, 6)):
        start, end = np.array([x, 2.35, -2.5]), np.array([x + rng.uniform(-0.6, 0.6), 2.35, 2.5])
        line = (1 - t) * start + t * end - 4 * t * (1 - t) * [0, rng.uniform(0.05, 0.3), 0]
        parts.append(bars(line[:-1], line[1:], 0.005, 6))
        if k == 2:
            parts.append(balls(line[4:-4:6] - [0, 0.04, 0], 0.04, 2))
    return joined(*parts)


def _small_boxes(rng: np.random.Generator) -> Shape:
    """A few open trays of bars and blocks on the bench."""
    at_x, high = np.linspace(-0.2, 0.5, 5), rng.uniform(0.04, 0.2, 5)
    lows = np.stack([at_x, np.zeros(5), rng.uniform(-0.25, 0.05, 5)], axis=1)
    return boxes(lows, lows + np.stack([np.full(5, 0.11), high, np.full(5, 0.15)], axis=1))
