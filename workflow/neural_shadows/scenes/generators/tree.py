"""A tree of branching limbs with sparse leaves, a table under it, a fence of pickets."""

import numpy as np

from neural_shadows.scenes.arrangement import Arrangement, Region, Spot
from neural_shadows.scenes.generators.building import floor
from neural_shadows.scenes.generators.furniture import bench, chair, table
from neural_shadows.scenes.generators.shapes import (
    Shape,
    at,
    balls,
    bars,
    beams,
    joined,
    leaves,
    placed,
)

TABLE = 0.75
ORDERS = 6  # of branching, the trunk's the first


def arrange(rng: np.random.Generator) -> Arrangement:
    """The tree behind the middle, its limbs between light and ground."""
    objects = (
        placed("ground", floor(8, 8)),
        placed("tree", *_tree(rng)),
        placed("table", at(table(1.2, 0.8, TABLE), (1.1, 0, 1.0), rng.uniform(-0.4, 0.4))),
        placed("chair", at(chair(), (0.0, 0, 1.4), 1.9 + rng.uniform(-0.3, 0.3))),
        placed("bench", at(bench(1.6), (-1.5, 0, 0.3), rng.uniform(0.2, 0.7))),
        placed("pickets", _pickets(rng)),
    )
    spots = (
        Spot(np.array([1.1, TABLE, 1.0]), 0.5, rng.uniform(0, 2 * np.pi)),
        Spot(np.array([-0.9, 0.0, 1.6]), 0.8, rng.uniform(0, 2 * np.pi)),
    )
    return Arrangement(
        "tree",
        objects,
        spots,
        lights=Region(np.array([-1.2, 5.2, -1.2]), np.array([1.2, 6.2, 1.2])),
        cameras=Region(np.array([-3.6, 0.9, 1.4]), np.array([3.6, 1.8, 3.8])),
        targets=Region(np.array([-1.8, 0.0, -1.6]), np.array([1.8, 1.0, 1.2])),
        mover="chair",
    )


def _tree(rng: np.random.Generator) -> list[Shape]:
    """Limbs as bars with balls at their joints, each order shorter and thinner, then leaves."""
    starts, ways = np.zeros((1, 3)), np.array([[0.0, 1.0, 0.0]])
    length, radius, parts = 1.5, 0.13, []
    for order in range(ORDERS):
        sections = max(6, 20 - 3 * order)
        ends = starts + length * rng.uniform(0.8, 1.1, (len(ways), 1)) * ways
        parts += [bars(starts, ends, radius, sections), balls(ends, radius, 2 if order < 3 else 1)]
        forks = 4 if order == 0 else 3 if order < 3 else 2
        out = rng.normal(0, 1, (len(ways) * forks, 3)) * [1, 0.45, 1]
        starts = np.repeat(ends, forks, axis=0)
        ways = np.repeat(ways, forks, axis=0) + 0.75 * out / np.linalg.norm(out, axis=1)[:, None]
        ways /= np.linalg.norm(ways, axis=1, keepdims=True)
        length, radius = 0.68 * length, 0.68 * radius
    feet = np.repeat(starts, 6, axis=0) + rng.normal(0, 0.09, (6 * len(starts), 3))
    hang = rng.normal(0, 0.5, feet.shape) - [0, 0.2, 0]
    parts.append(leaves(feet, feet + 0.2 * hang, 0.09))
    return parts


def _pickets(rng: np.random.Generator) -> Shape:
    """A fence of pickets of uneven height behind the tree."""
    x = np.linspace(-3.6, 3.6, 46)
    high = 1.0 + rng.uniform(-0.06, 0.06, 46)
    feet = np.stack([x, np.zeros(46), np.full(46, -2.2)], axis=1)
    rails = np.array([[-3.7, y, -2.235] for y in (0.3, 0.8)])
    return joined(
        beams(feet, feet + high[:, None] * [0, 1, 0], 0.02, 0.08),
        beams(rails, rails * [-1, 1, 1], 0.03, 0.06),
    )
