import numpy as np

AXIS = (2 * np.arange(64) + 1) / 64 - 1
A, B = np.meshgrid(AXIS, AXIS)  # texel centres
SILHOUETTES = {
    "half plane": A > 0,
    "disc": np.hypot(A - 0.2, B + 0.1) < 0.5,
    "texel": (A == AXIS[9]) & (B == AXIS[5]),
    "nothing": A > 2,
    "all": A < 2,
}


def leaves_by_definition(silhouette, min_quad):
    """The definition read out, in the Z-order of the quads."""
    resolution = len(silhouette)
    found = []

    def visit(row, column, size):
        lines = np.array([[row, row + size], [column, column + size]]) * 2 / resolution - 1
        nearest = np.where(lines[:, 0] > 0, lines[:, 0], np.minimum(lines[:, 1], 0))
        if np.hypot(*nearest) >= 1:
            return
        texels = silhouette[row : row + size, column : column + size]
        if size == min_quad or texels.all() or not texels.any():
            found.append((row, column, size))
            return
        half = size // 2
        for i in (0, half):
            for j in (0, half):
                visit(row + i, column + j, half)

    visit(0, 0, resolution)
    return np.array(found)
