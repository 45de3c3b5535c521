"""Court of 14 m × 7 m with arcades and hanging cloths.

6 m high, a substitute for Sponza (Datta et al. 2022): shadows at contact and very wide penumbrae in one frame.
"""

import numpy as np

from neural_shadows.scenes.arrangement import Arrangement, Region, Spot
from neural_shadows.scenes.pieces.building import arcade, balustrade, column, floor, walls
from neural_shadows.scenes.pieces.furniture import plant, vase
from neural_shadows.scenes.pieces.shapes import Shape, at, bars, box, joined, placed, smooth

SPRING = 2.4  # height of the columns
GALLERY = 3.8  # height of the galleries' floor
ROW = 2.1  # of the columns, from the middle
SPAN = 2.4


def arrange(rng: np.random.Generator) -> Arrangement:
    """Two rows of columns with galleries, two cloths, urns, plants."""
    columns = [
        (f"columns {side}", [at(column(SPRING), ((k - 2.5) * SPAN, 0, z)) for k in range(6)])
        for side, z in (("left", -ROW), ("right", ROW))
    ]
    hung = [rng.uniform(-4.4, -3.2), rng.uniform(3.2, 4.4)]
    urns = [
        np.array([x + rng.uniform(-0.3, 0.3), 0.0, z]) for x in (-2.4, 2.4) for z in (-1.2, 1.2)
    ]
    objects = (
        placed("floor", floor(14, 7)),
        placed("walls", walls(14, 7, 6)),
        *(placed(name, *shapes) for name, shapes in columns),
        placed("gallery left", at(_gallery(), (0, 0, -ROW), 0)),
        placed("gallery right", at(_gallery(), (0, 0, ROW), np.pi)),
        *(placed(f"cloth {k + 1}", at(_cloth(rng), (x, 0, 0))) for k, x in enumerate(hung)),
        *(placed(f"urn {k + 1}", at(vase(rng.uniform(0.6, 0.9)), p)) for k, p in enumerate(urns)),
        placed("plant", at(plant(rng, 1.6), (5.9, 0, 1.1))),
    )
    positions = [(0.0, 1.2), (2.4, 0.9), (-2.4, 0.9)]
    spots = tuple(
        Spot(np.array([x, 0.0, 0.0]), high, rng.uniform(0, 2 * np.pi)) for x, high in positions
    )
    return Arrangement(
        "atrium",
        objects,
        spots,
        lights=Region(np.array([-2.2, 3.4, -1.2]), np.array([2.2, 5.2, 1.2])),
        cameras=Region(np.array([-6.2, 1.2, -1.6]), np.array([6.2, 2.2, 1.6])),
        targets=Region(np.array([-2.5, 0.2, -1.5]), np.array([2.5, 2.6, 1.5])),
        mover="urn 1",
    )


def _gallery() -> Shape:
    """Arches along x, gallery floor towards −z, balusters in front."""
    half = 2.5 * SPAN + 0.2
    ends = [-half - 0.8, half + 0.8]
    return joined(
        arcade(5, SPAN, SPRING, GALLERY - 0.15),
        box((ends[0], GALLERY - 0.15, -1.4), (ends[1], GALLERY, 0.3)),
        balustrade((ends[0], GALLERY, 0.2), (ends[1], GALLERY, 0.2)),
    )


def _cloth(rng: np.random.Generator) -> Shape:
    """A cloth across the court, from a pole between the galleries."""
    height, half = GALLERY + 0.03, ROW - 0.55
    u, v = np.meshgrid(np.linspace(-1, 1, 49), np.linspace(0, 1, 33), indexing="ij")
    phase, sway = rng.uniform(0, 2 * np.pi), rng.uniform(0.08, 0.16)
    x = sway * (0.25 + v) * np.sin(5 * u + phase + 1.5 * v) + 0.03 * np.sin(19 * u + phase)
    y = height - v * (rng.uniform(1.3, 1.7) + 0.12 * np.cos(np.pi * u))
    hanging = smooth(np.stack([x * np.minimum(1, 6 * v), y, half * u], axis=-1))
    return joined(hanging, bars([[0, height, -ROW]], [[0, height, ROW]], 0.025, 12))
