"""The procedural oak: a trunk that forks into limbs, and thick leaves at their ends, one closed mesh.

y is up and the oak about 2 high, standing on y = 0.
"""

import numpy as np

from neural_shadows.meshes.meshed_parts import meshed
from neural_shadows.meshes.signed_distances import Part

SEED = 11
TRUNK, RADIUS = 0.75, 0.07  # length, and radius at the foot
FORKS = (5, 4, 3)  # of the trunk, of a limb, of a twig
SHRINK = 0.62  # of length and radius from each order to the next
SPREAD = 0.8  # how far a fork turns away
LEAVES = 3  # at each end
LEAF = np.array([0.075, 0.05, 0.016])  # semi-axes


def make_oak(*, cells: int) -> tuple[np.ndarray, np.ndarray]:
    """Mesh of the oak, see `meshed`; a leaf is 4 cells thick at 256 `cells`."""
    rng = np.random.default_rng(SEED)
    limbs, ends = _limbs(rng)
    return meshed([Part(limbs, 0.02), Part(_leaves(ends, rng), 0.01)], cells)


def _limbs(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Cones (n, 2, 4) of all orders, and the ends (m, 3) of the last."""
    starts, ways = np.zeros((1, 3)), np.array([[0.0, 1.0, 0.0]])
    length, radius, found = TRUNK, RADIUS, []
    for forks in (*FORKS, 0):
        ends = starts + length * rng.uniform(0.8, 1.2, (len(ways), 1)) * ways
        rows = np.stack([starts, ends], axis=1)
        radii = np.broadcast_to([[[radius], [SHRINK * radius]]], (len(ways), 2, 1))
        found.append(np.concatenate([rows, radii], axis=2))
        starts = np.repeat(ends, max(forks, 1), axis=0)
        out = rng.normal(0, 1, (len(starts), 3)) * [1, 0.5, 1]
        ways = np.repeat(ways, max(forks, 1), axis=0)
        ways = ways + SPREAD * out / np.linalg.norm(out, axis=1)[:, None]
        ways /= np.linalg.norm(ways, axis=1, keepdims=True)
        length, radius = SHRINK * length, SHRINK * radius
    return np.concatenate(found), ends


def _leaves(ends: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Flat ellipsoids (n, 4, 3) that begin at the limbs' ends (m, 3), turned at random."""
    ends = np.repeat(ends, LEAVES, axis=0)
    axes, _ = np.linalg.qr(rng.normal(0, 1, (len(ends), 3, 3)))  # orthonormal columns
    axes = np.swapaxes(axes, 1, 2) * LEAF[:, None]
    return np.concatenate([(ends + 0.8 * axes[:, 0])[:, None], axes], axis=1)
