"""Whether a mesh is a sheet without an inside."""

import numpy as np
import trimesh


def is_sheet(vertices: np.ndarray, faces: np.ndarray) -> bool:
    return False
