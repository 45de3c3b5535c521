"""Stairwell: two flights, a landing, a chandelier on a beam."""

import numpy as np

from neural_shadows.scenes.arrangement import Arrangement, Region, Spot
from neural_shadows.scenes.pieces.building import balustrade, column, flight, floor
from neural_shadows.scenes.pieces.furniture import plant, vase
from neural_shadows.scenes.pieces.shapes import (
    Shape,
    at,
    balls,
    bars,
    beams,
    box,
    boxes,
    joined,
    lathe,
    placed,
    ring,
)

RISE, GOING, STEPS = 0.17, 0.28, 10
LANDING = STEPS * RISE
WALL = 4.6


def arrange(rng: np.random.Generator) -> Arrangement:
    """Flights from both sides to a landing; a chandelier in front."""
    run = STEPS * GOING
    lamp = np.array([rng.uniform(-0.4, 0.4), 0, rng.uniform(0.3, 0.8)])
    objects = (
        placed("floor", floor(10, 7)),
        placed(
            "walls", boxes([[-5, 0, -3.6], [-5.1, 0, -3.5]], [[5, WALL, -3.5], [-5, WALL, 3.5]])
        ),
        placed("landing", *_landing(4.0 - run)),
        placed("left flight", at(flight(STEPS, 1.3, RISE, GOING), (-4, 0, -2.7))),
        placed("right flight", at(flight(STEPS, 1.3, RISE, GOING), (4, 0, -2.7), np.pi)),
        placed("left rail", _rail(-1)),
        placed("right rail", _rail(1)),
        placed("chandelier", _chandelier(lamp)),
        placed("urn", at(vase(0.8), (rng.uniform(-2.2, -1.5), 0, rng.uniform(-1.2, -0.6)))),
        placed("plant", at(plant(rng, 1.4), (3.3, 0, rng.uniform(-0.6, 0)))),
    )
    spots = (
        Spot(np.array([0.0, LANDING, -2.9]), 0.7, rng.uniform(0, 2 * np.pi)),
        Spot(np.array([0.4, 0.0, -0.6]), 1.2, rng.uniform(0, 2 * np.pi)),
    )
    return Arrangement(
        "stairs",
        objects,
        spots,
        lights=Region(np.array([-1.6, 3.9, 1.5]), np.array([1.6, 4.6, 2.6])),
        cameras=Region(np.array([-3.4, 1.1, 0.6]), np.array([3.4, 2.3, 3.2])),
        targets=Region(np.array([-2.6, 0.2, -2.8]), np.array([2.6, 1.8, -0.6])),
        mover="urn",
    )


def _landing(half: float) -> list[Shape]:
    """A slab on columns between the flights, with balusters."""
    front = -2.05
    return [
        box((-half, LANDING - 0.15, -3.5), (half, LANDING, front)),
        *(at(column(LANDING - 0.15, 0.1), (x, 0, front - 0.2)) for x in (-0.9, 0.9)),
        balustrade((-half, LANDING, front - 0.05), (half, LANDING, front - 0.05), apart=0.13),
    ]


def _rail(side: int) -> Shape:
    """Balusters along a flight's front, with a newel."""
    first = np.array([side * (4 - GOING / 2), RISE, -2.1])
    last = np.array([side * (4 - (STEPS - 0.5) * GOING), LANDING, -2.1])
    newel = [
        [0, 0],
        [0.07, 0],
        [0.07, 0.3],
        [0.05, 0.35],
        [0.05, 1],
        [0.08, 1.05],
        [0.06, 1.15],
        [0, 1.2],
    ]
    foot = at(lathe(newel, 20), (side * 4.1, 0, -2.1))
    return joined(balustrade(first, last, 0.9, 0.14), foot)


def _chandelier(middle: np.ndarray) -> Shape:
    """Two rings of candles on chains from a beam."""
    parts, angle = [], 2 * np.pi * np.arange(12) / 12
    out = np.stack([np.cos(angle), np.zeros(12), np.sin(angle)], axis=1)
    for radius, height in ((0.6, 2.5), (0.35, 2.75)):
        hub = middle + [0, height, 0]
        feet = hub + radius * out + [0, 0.01, 0]
        parts += [
            at(ring(radius, 0.012), hub),
            bars(hub + 0.02 * out, hub + radius * out, 0.006),
            bars(feet, feet + [0, 0.12, 0], 0.012, 12),
            bars(hub + radius * out[::3], np.tile(middle + [0, 3.15, 0], (4, 1)), 0.004, 6),
        ]
    beads = middle + [0, 2.42, 0] + np.concatenate([0.6 * out, 0.3 * out])
    hooks = bars(beads[:12], beads[:12] + [0, 0.08, 0], 0.002, 6)
    rod = bars([middle + [0, 2.4, 0]], [middle + [0, 3.5, 0]], 0.02, 12)
    beam_at = middle * [0, 0, 1] + [0, 3.5, 0]
    beam = beams([beam_at - [5, 0, 0]], [beam_at + [4.9, 0, 0]], 0.1, 0.14)
    support = at(column(3.43, 0.14), beam_at * [0, 0, 1] + [4.6, 0, 0])
    return joined(*parts, balls(beads[:12], 0.03, 2), hooks, rod, beam, support)
