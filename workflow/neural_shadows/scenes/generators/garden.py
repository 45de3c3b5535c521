"""Garden of 8 m × 7 m: plants, fence, pergola, grass."""

import numpy as np

from neural_shadows.meshes.fence import make_fence
from neural_shadows.scenes.arrangement import Arrangement, Region, Spot
from neural_shadows.scenes.pieces.building import floor
from neural_shadows.scenes.pieces.furniture import bench, grille, plant
from neural_shadows.scenes.pieces.outdoors import blades_in, pergola, stones
from neural_shadows.scenes.pieces.shapes import Shape, at, placed

PANEL = 2.0  # width of a panel of the fence
PERGOLA = 2.2  # height of its slats
LAWN = np.array([1.2, 0.0, -0.4])


def arrange(rng: np.random.Generator) -> Arrangement:
    """Plants along a fence and a lawn, a pergola."""
    beds = [(-3.2, -2.4), (-2.0, -2.6), (-0.6, -2.5), (0.9, -2.6), (2.2, -2.4), (3.3, -2.5)]
    beds += [(3.2, 0.4), (-3.3, 0.6), (2.6, 1.5), (-2.8, 2.0)]
    positions = np.array([[x, 0, z] for x, z in beds]) + rng.uniform(-0.15, 0.15, (10, 3)) * [
        1,
        0,
        1,
    ]
    panels = [at(_panel(), (x, 0, -3.2)) for x in (-PANEL, 0)]
    panels += [at(grille(PANEL - 0.06, 1.5, 0.1), (x * PANEL, 0, -3.2)) for x in (-1.5, 1.5)]
    objects = (
        placed("ground", floor(8, 7)),
        placed("fence", *panels),
        *(
            placed(f"plant {k + 1}", at(plant(rng, rng.uniform(0.9, 1.7), 110), position))
            for k, position in enumerate(positions)
        ),
        placed("pergola", at(pergola(2.6, 2.2, PERGOLA, 18), (-1.7, 0, 0))),
        placed("bench", at(bench(1.6), (-1.7, 0, -0.9))),
        placed("grass", _grass(rng, 700)),
        placed("stones", stones(rng, np.linspace([2.8, 0, 2.8], [-0.9, 0, 0.6], 9))),
    )
    spots = (
        Spot(np.array([-1.7, 0.0, 0.2]), 0.9, rng.uniform(0, 2 * np.pi)),
        Spot(LAWN, 1.0, rng.uniform(0, 2 * np.pi)),
    )
    return Arrangement(
        "garden",
        objects,
        spots,
        lights=Region(np.array([-1.5, 3.2, -1.8]), np.array([1.8, 4.4, 0.8])),
        cameras=Region(np.array([-3.6, 1.1, 1.2]), np.array([3.6, 2.0, 3.3])),
        targets=Region(np.array([-2.2, 0.0, -2.2]), np.array([2.2, 0.9, 0.4])),
        mover="bench",
    )


def _panel() -> Shape:
    """A panel of the woven fence, its left end at the origin."""
    vertices, faces = make_fence(wires=6, wire_radius=0.005)
    return Shape(vertices * PANEL, faces, process=False)


def _grass(rng: np.random.Generator, blades: int) -> Shape:
    """Blades in tufts over the lawn's right half."""
    tufts = rng.uniform([0.3, -2.0], [3.4, 2.4], (50, 2))
    tufts = tufts[np.linalg.norm(tufts - LAWN[[0, 2]], axis=1) > 0.85]  # clear of the spot
    return blades_in(rng, tufts, blades)
