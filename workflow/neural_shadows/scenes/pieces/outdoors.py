"""Outdoor objects of random sizes in metres, standing on y = 0."""

import numpy as np

from neural_shadows.scenes.pieces.plan import Drawn
from neural_shadows.scenes.pieces.shapes import (
    Shape,
    at,
    balls,
    bars,
    beams,
    box,
    boxes,
    copies,
    joined,
    lathe,
    leaves,
    smooth,
)


def tree(
    rng: np.random.Generator, trunk: float, orders: int = 6, leaf: float = 0.09
) -> list[Shape]:
    """A tree of limbs with balls at joints, and leaves.

    Args:
        trunk: its length. orders: of branching, the trunk's the first. leaf: width of a leaf.
    """
    starts, directions = np.zeros((1, 3)), np.array([[0.0, 1.0, 0.0]])
    length, radius, parts = trunk, 0.13 / 1.5 * trunk, []
    for order in range(orders):
        sections = max(6, 20 - 3 * order)
        ends = starts + length * rng.uniform(0.8, 1.1, (len(directions), 1)) * directions
        parts += [bars(starts, ends, radius, sections), balls(ends, radius, 2 if order < 3 else 1)]
        forks = 4 if order == 0 else 3 if order < 3 else 2
        out = rng.normal(0, 1, (len(directions) * forks, 3)) * [1, 0.45, 1]
        starts = np.repeat(ends, forks, axis=0)
        directions = (
            np.repeat(directions, forks, axis=0) + 0.75 * out / np.linalg.norm(out, axis=1)[:, None]
        )
        directions /= np.linalg.norm(directions, axis=1, keepdims=True)
        length, radius = 0.68 * length, 0.68 * radius
    feet = np.repeat(starts, 6, axis=0) + rng.normal(0, 0.09, (6 * len(starts), 3))
    hang = rng.normal(0, 0.5, feet.shape) - [0, 0.2, 0]
    parts.append(leaves(feet, feet + 0.2 * hang, leaf))
    return parts


def pergola(
    width: float, depth: float, height: float, slats: int, slat: tuple[float, float] = (0.035, 0.06)
) -> Shape:
    """Four posts, two beams along x and slats across them.

    Args:
        width, depth: between the posts. height: of the slats' foot. slat: its width and height.
    """
    x, z = width / 2, depth / 2
    posts = np.array([[a, 0, b] for a in (-x, x) for b in (-z, z)])
    under = height - 0.12
    starts = np.array([[-x - 0.2, under + 0.06, b] for b in (-z, z)])
    along = np.linspace(-x - 0.1, x + 0.1, slats)[:, None] * [1, 0, 0]
    rows = along + [0, height + slat[1] / 2, -z - 0.25]
    return joined(
        boxes(posts - [0.05, 0, 0.05], posts + [0.05, under, 0.05]),
        beams(starts, starts * [-1, 1, 1], 0.06, 0.12),
        beams(rows, rows + [0, 0, depth + 0.5], *slat),
    )


def pickets(rng: np.random.Generator, width: float, apart: float = 0.16) -> Shape:
    """A picket fence of uneven height, `width` along x."""
    x = np.arange(-width / 2, width / 2 + 1e-6, apart)
    high = 1.0 + rng.uniform(-0.06, 0.06, len(x))
    feet = np.stack([x, np.zeros(len(x)), np.zeros(len(x))], axis=1)
    rails = np.array([[-width / 2 - 0.1, y, -0.035] for y in (0.3, 0.8)])
    return joined(
        beams(feet, feet + high[:, None] * [0, 1, 0], 0.02, 0.08),
        beams(rails, rails * [-1, 1, 1], 0.03, 0.06),
    )


def paving(rng: np.random.Generator, width: float, depth: float, stone: float) -> Shape:
    """Paving stones with gaps, 1 to 3 cm high."""
    n, m = max(2, round(width / stone)), max(2, round(depth / stone))
    a, b = width / n, depth / m
    x, z = np.meshgrid(np.arange(n) * a - width / 2, np.arange(m) * b - depth / 2, indexing="ij")
    lows = np.stack([x, np.zeros_like(x), z], axis=-1).reshape(-1, 3)
    proud = rng.uniform(0.01, 0.03, len(lows))
    highs = lows + np.stack([np.full(len(lows), a), proud, np.full(len(lows), b)], axis=1)
    gap = rng.uniform(0.006, 0.02, (len(lows), 1)) * [1, 0, 1]
    return boxes(lows + gap, highs - gap)


def stall(rng: np.random.Generator, width: float, height: float = 2.1) -> Shape:
    """A market table under a striped awning, open to +z."""
    x, z = width / 2, 0.55
    posts = np.array([[a, 0, b] for a in (-x, x) for b in (-z, z)])
    tops = np.where(posts[:, 2:] > 0, height - 0.35, height)
    u, v = np.meshgrid(np.linspace(-1, 1, 41), np.linspace(0, 1, 17), indexing="ij")
    sag = 0.06 * np.sin(np.pi * v) + 0.025 * np.cos(16 * u) * np.sin(np.pi * v)
    sheet = np.stack(
        [(x + 0.15) * u, height - 0.45 * v + 0.02 - sag, -z - 0.05 + (2 * z + 0.3) * v], axis=-1
    )
    crates = np.linspace(-x + 0.2, x - 0.2, max(2, round(width / 0.45)))
    lows = np.stack(
        [crates - 0.16, np.full(len(crates), 0.82), rng.uniform(-0.3, 0, len(crates))], 1
    )
    fruit = lows.repeat(8, 0) + rng.uniform(
        [0.06, 0.13, 0.06], [0.26, 0.16, 0.3], (8 * len(lows), 3)
    )
    return joined(
        beams(posts, posts + tops * [0, 1, 0], 0.05, 0.05),
        beams(
            [[-x, height, -z], [-x, height - 0.35, z]],
            [[x, height, -z], [x, height - 0.35, z]],
            0.04,
            0.04,
        ),
        smooth(sheet),
        box((-x, 0.78, -0.45), (x, 0.82, 0.45)),
        boxes(lows, lows + [0.32, 0.12, 0.36]),
        balls(fruit, 0.045, 1),
    )


def fountain(radius: float) -> Shape:
    """A round basin with a bowl on a stem in its middle."""
    r = radius
    basin = [
        (0, 0),
        (r, 0),
        (r, 0.36),
        (1.05 * r, 0.4),
        (0.88 * r, 0.4),
        (0.86 * r, 0.12),
        (0, 0.1),
    ]
    bowl = [(0, 0.1), (0.16, 0.1), (0.07, 0.3), (0.06, 0.85), (0.45 * r, 1.05), (0.47 * r, 1.1)]
    bowl += [(0.1, 0.95), (0.05, 1.3), (0, 1.32)]
    return joined(lathe(basin, 40), lathe(bowl, 32))


def pole(foot: np.ndarray, height: float) -> Shape:
    """A round pole at a position (3,) with a knob."""
    top = foot + [0, height, 0]
    return joined(bars([foot], [top], 0.03, 14), balls([top], 0.045, 2))


def lantern(rng: np.random.Generator) -> Drawn:
    """A post with two arms along x, each with a lantern."""
    arm = rng.uniform(0.2, 0.32)
    height = rng.uniform(1.4, 1.8)
    foot = [(0, 0), (0.13, 0), (0.13, 0.08), (0.05, 0.14), (0.04, height), (0.0, height + 0.03)]
    ends = np.array([[-arm, height - 0.1, 0], [arm, height - 0.1, 0]])
    angle = 2 * np.pi * np.arange(10) / 10
    out = 0.11 * np.stack([np.cos(angle), np.zeros(10), np.sin(angle)], axis=1)
    feet = (ends[:, None] + out - [0, 0.34, 0]).reshape(-1, 3)
    tops = (ends[:, None] + 0.6 * out - [0, 0.05, 0]).reshape(-1, 3)
    cap = lathe([(0, 0), (0.13, 0), (0.02, 0.09), (0, 0.09)], 16)
    floor = lathe([(0, 0), (0.12, 0), (0.12, 0.02), (0, 0.02)], 16)
    shape = joined(
        lathe(foot, 16),
        bars(ends[:1], ends[1:], 0.018, 10),
        bars(feet, tops, 0.006, 6),
        *(at(cap, end - [0, 0.06, 0]) for end in ends),
        *(at(floor, end - [0, 0.36, 0]) for end in ends),
    )
    return shape, 2 * arm + 0.3, 0.4


def grass(rng: np.random.Generator, width: float, depth: float, blades: int) -> Shape:
    """Blades in tufts over a rectangle about the origin."""
    half = np.array([width, depth]) / 2
    return blades_in(rng, rng.uniform(-half, half, (max(4, blades // 14), 2)), blades)


def blades_in(rng: np.random.Generator, tufts: np.ndarray, blades: int) -> Shape:
    """Blades of grass around the middles of tufts, (n, 2)."""
    feet = tufts[rng.integers(len(tufts), size=blades)] + rng.normal(0, 0.07, (blades, 2))
    feet = np.stack([feet[:, 0], np.full(blades, 1e-3), feet[:, 1]], axis=1)
    bent = rng.normal(0, 0.06, (blades, 3)) * [1, 0, 1]
    return leaves(feet, feet + bent + rng.uniform(0.1, 0.3, (blades, 1)) * [0, 1, 0], 0.012)


def trellis(width: float, height: float, apart: float = 0.14) -> Shape:
    """Crossed laths between two posts, `width` along x."""
    x = width / 2
    starts, ends = [], []
    for c in np.arange(-x - height + apart, x, apart):
        low, high = max(c, -x), min(c + height, x)
        if high - low > 0.05:
            starts.append([low, low - c, 0.008])
            ends.append([high, high - c, 0.008])
    starts, ends = np.array(starts) + [0, 0.02, 0], np.array(ends) + [0, 0.02, 0]
    other = np.array([-1, 1, -1])
    posts = np.array([[-x, 0, 0], [x, 0, 0]])
    return joined(
        beams(starts, ends, 0.012, 0.025),
        beams(starts * other, ends * other, 0.012, 0.025),
        beams(posts, posts + [0, height + 0.08, 0], 0.06, 0.06),
    )


def stones(rng: np.random.Generator, path: np.ndarray) -> Shape:
    """Flat round stones at points (n, 3)."""
    stone = lathe([(0, 0), (1, 0), (0.97, 0.1), (0.85, 0.17), (0, 0.19)], 16)
    transforms = rng.uniform(0.13, 0.19, (len(path), 1, 1)) * np.eye(4)
    transforms[:, :3, 3], transforms[:, 3, 3] = path, 1
    return copies(stone, transforms)
