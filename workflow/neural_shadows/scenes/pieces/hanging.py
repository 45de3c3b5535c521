"""Hanging objects in metres, suspended from the origin."""

import numpy as np

from neural_shadows.scenes.pieces.shapes import (
    Shape,
    at,
    balls,
    bars,
    beams,
    joined,
    lathe,
    leaves,
    ring,
    smooth,
)


def ring_lamp(drop: float, radius: float, spokes: int = 16) -> Shape:
    """Two level rings with spokes, on a rod of length `drop`."""
    angle = 2 * np.pi * np.arange(spokes) / spokes
    out = radius * np.stack([np.cos(angle), np.zeros(spokes), np.sin(angle)], axis=1)
    hub = np.array([0, -drop, 0])
    return joined(
        bars([[0, 0, 0]], [hub - [0, 0.03, 0]], 0.008, 10),
        at(ring(radius, 0.014), hub),
        at(ring(0.55 * radius, 0.01), hub),
        bars(hub + 0.05 * out, hub + out, 0.007),
    )


def shade_lamp(drop: float, radius: float) -> Shape:
    """A closed bell on a rod of length `drop`."""
    profile = np.array([(0, 0), (1, 0), (0.95, 0.1), (0.55, 0.75), (0.2, 0.9), (0, 0.95)])
    rod = bars([[0, 0, 0]], [[0, -drop, 0]], 0.008, 10)
    return joined(rod, at(lathe(profile * radius, 32), (0, -drop - 0.9 * radius, 0)))


def basket(drop: float, radius: float, ribs: int = 12) -> Shape:
    """A ball in a round cage, on a rod of length `drop`."""
    angle = 2 * np.pi * np.arange(ribs) / ribs
    out = np.stack([np.cos(angle), np.zeros(ribs), np.sin(angle)], axis=1)
    bend = np.linspace(-np.pi / 2, np.pi / 2, 9)[:, None, None]
    bent = radius * (np.cos(bend) * out + np.sin(bend) * [0, 1, 0]) - [0, drop + radius, 0]
    return joined(
        bars([[0, 0, 0]], [[0, -drop, 0]], 0.006, 8),
        bars(bent[:-1].reshape(-1, 3), bent[1:].reshape(-1, 3), 0.006, 6),
        balls([[0, -drop - radius, 0]], 0.45 * radius, 2),
    )


def banner(rng: np.random.Generator, width: float, drop: float) -> Shape:
    """A folded cloth, `width` along x and `drop` long."""
    u, v = np.meshgrid(np.linspace(-1, 1, 33), np.linspace(0, 1, 25), indexing="ij")
    phase, folds = rng.uniform(0, 2 * np.pi), rng.uniform(3, 7)
    z = 0.05 * np.minimum(1, 4 * v) * np.sin(folds * u + phase + v)
    y = -drop * v * (1 - 0.06 * np.cos(np.pi * u))
    return smooth(np.stack([width / 2 * u, y, z], axis=-1))


def mobile(rng: np.random.Generator, drop: float, arms: int = 5) -> Shape:
    """A mobile of arms with discs, on a thread `drop` long."""
    parts, hub = [bars([[0, 0, 0]], [[0, -drop, 0]], 0.004, 6)], np.array([0, -drop, 0])
    disc = lathe([(0, 0), (0.09, 0), (0.09, 0.012), (0, 0.012)], 24)
    for k in range(arms):
        turn, half = rng.uniform(0, np.pi), rng.uniform(0.25, 0.5)
        out = half * np.array([np.cos(turn), 0, np.sin(turn)])
        ends = np.array([hub + out, hub - out])
        low = ends - [0, 0.1, 0]
        parts += [bars(ends[:1], ends[1:], 0.006, 8), bars(ends, low, 0.003, 6)]
        parts += [at(disc, end - [0, 0.012, 0], rng.uniform(0, 1)) for end in low]
        below = hub - [0, 0.14, 0]
        if k < arms - 1:
            parts.append(bars([hub], [below], 0.004, 6))
        hub = below
    return joined(*parts)


def wires(
    rng: np.random.Generator, starts, ends, *, bulbs: bool = True, pennants: bool = False
) -> Shape:
    """Sagging wires between points (n, 3), with bulbs or pennants."""
    parts, t = [], np.linspace(0, 1, 33)[:, None]
    for start, end in zip(np.asarray(starts, float), np.asarray(ends, float)):
        line = (1 - t) * start + t * end - 4 * t * (1 - t) * [0, rng.uniform(0.1, 0.35), 0]
        parts.append(bars(line[:-1], line[1:], 0.006, 6))
        if bulbs:
            parts.append(balls(line[3:-3:4] - [0, 0.05, 0], 0.05, 2))
        if pennants:
            feet = line[2:-2:2]
            sway = rng.uniform(-0.06, 0.06, feet.shape) * [1, 0, 1]
            parts.append(leaves(feet, feet + sway - [0, 0.3, 0], 0.22))
    return joined(*parts)


def frame_over(ends, height: float, post: float = 0.1) -> Shape:
    """Beams on posts between points (n, 2, 3), tops at `height`."""
    ends = np.asarray(ends, float)
    feet = ends.reshape(-1, 3)
    under = height - 1.4 * post
    up = np.array([0, under, 0])
    middle = np.array([0, height - 0.7 * post, 0])
    out = (ends[:, 1] - ends[:, 0]) / np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)[:, None]
    return joined(
        beams(feet, feet + up, post, post),
        beams(ends[:, 0] + middle - 0.06 * out, ends[:, 1] + middle + 0.06 * out, post, 1.4 * post),
    )
