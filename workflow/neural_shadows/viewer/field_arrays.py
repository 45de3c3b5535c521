"""Fields of distances in bricks as compact arrays for a browser; see field_textures.js."""

from typing import Any

import numpy as np

from neural_shadows.representations.distance_bricks.brick_layout import lay_out
from neural_shadows.representations.distance_bricks.distances_around import distances_around
from neural_shadows.representations.distance_bricks.field_marching import BRICK
from neural_shadows.representations.shadow_field.grid_codes import grid_codes
from neural_shadows.representations.shadow_field.shadow_field import PUSH, ShadowField
from neural_shadows.viewer.packed import packed, zigzag

STEP_CELLS = 1 / 8  # of a distance around a field


def field_arrays(field: ShadowField) -> dict[str, Any]:
    """A solid's field for cones.

    `centre` and `radius` of its sphere in the mesh's own unit, and what `cone_arrays` gives.
    """
    bricks = field.cone_field.bricks
    layout = lay_out(field.grid >= 0, solid=False)
    values = np.empty(layout.count, np.int8)
    values[layout.table] = bricks  # shared ones once, in the order of places
    arrays = {"grid": packed(grid_codes(field.grid.ravel())), "values": packed(values)}
    cones = cone_arrays(field.grid, bricks, float(field.cone_field.unit), PUSH)
    return {
        "centre": field.centre.tolist(),
        "radius": field.radius,
        "bricks": len(field.grid),
        **cones,
        "arrays": arrays | cones["arrays"],
    }


def cone_arrays(grid: np.ndarray, bricks: np.ndarray, unit: float, push: float) -> dict[str, Any]:
    """Constants of cones through a field, and the array of distances `around` it.

    Args:
        grid, bricks: see `distances_around`.
        unit: of the bricks' values, in radii. push: of the surface outwards, in cells.
    """
    step = 2 / (len(grid) * BRICK) * STEP_CELLS
    around = packed(_differences(distances_around(grid, bricks), step))
    return {"unit": unit, "push": push, "step": step, "arrays": {"around": around}}


def _differences(distances: np.ndarray, step: float) -> np.ndarray:
    """A cube's values in steps, as differences along all three axes; zigzag uint16.

    Of the Stanford dragon at 256³ 104 KiB, deflated; as halves 299.
    """
    steps = np.round(distances / step).astype(np.int64)
    for axis in range(3):
        steps = np.diff(steps, axis=axis, prepend=0)
    return zigzag(steps)
