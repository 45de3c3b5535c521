"""Procedural landscape: height field with extrusions, an open sheet [4.1.1].

y is up, over the square −1 ≤ x, z ≤ 1: hills of low frequency, and plateaus raised out of them
with steep, rounded sides.
"""

import numpy as np

from neural_shadows.meshes.height_grid import height_grid

SEED = 7  # of positions, sizes and heights
PLATEAUS = 12
HILLS = 10
HILL_HEIGHT = (0.05, 0.16)
HILL_RADIUS = (0.22, 0.5)
PLATEAU_HEIGHT = (0.12, 0.34)
PLATEAU_RADIUS = (0.07, 0.2)
# Half the width of a plateau's side: 5 cells of the default grid, so that no step is one face.
SHOULDER = 0.02


def make_landscape(*, cells: int) -> tuple[np.ndarray, np.ndarray]:
    """Vertices ((cells + 1)², 3) float64 and faces (2 cells², 3) int64.

    Faces are wound counter-clockwise from above.

    Args:
        cells: grid cells along a side, 1 or more.
    """
    side = np.linspace(-1, 1, cells + 1)
    x, z = np.meshgrid(side, side, indexing="ij")
    return height_grid(x, _heights(x, z), z)


def _heights(x: np.ndarray, z: np.ndarray) -> np.ndarray:
    rng = np.random.default_rng(SEED)
    height = np.zeros_like(x)
    for _ in range(HILLS):
        middle, radius = rng.uniform(-1, 1, 2), rng.uniform(*HILL_RADIUS)
        distance = np.hypot(x - middle[0], z - middle[1])
        height += rng.uniform(*HILL_HEIGHT) * np.exp(-((distance / radius) ** 2))
    raised = np.zeros_like(x)  # the highest where plateaus overlap: their sum would be spires
    for _ in range(PLATEAUS):
        middle, angle = rng.uniform(-0.85, 0.85, 2), rng.uniform(0, np.pi)
        radii = rng.uniform(*PLATEAU_RADIUS, 2)
        along = np.cos(angle) * (x - middle[0]) + np.sin(angle) * (z - middle[1])
        across = np.cos(angle) * (z - middle[1]) - np.sin(angle) * (x - middle[0])
        # A rounded rectangle: level lines of the fourth-power norm, 1 on the rim.
        rim = ((along / radii[0]) ** 4 + (across / radii[1]) ** 4) ** 0.25
        outside = (rim - 1) * radii.min()
        plateau = rng.uniform(*PLATEAU_HEIGHT) * (0.5 - 0.5 * np.tanh(outside / SHOULDER))
        raised = np.maximum(raised, plateau)
    return height + raised
