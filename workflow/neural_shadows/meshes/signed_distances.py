"""Grids of signed distances to cones, wedges and ellipsoids."""

from dataclasses import dataclass

import numpy as np

# Least radius or half thickness in cells. A ball of radius sqrt(3)/2 cells always contains a grid
# sample, so that thicker pieces are not torn.
MIN_RADIUS_CELLS = 0.9
_FAR = np.float32(1e3)


@dataclass(frozen=True)
class Part:
    """Pieces of one kind, joined smoothly with previous parts.

    Pieces are joined sharply with each other. The shape of `pieces` gives the kind:
    (n, 2, 4) cones, the rows being two ends (x, y, z, radius);
    (n, 3, 4) wedges, three corners (x, y, z, half thickness);
    (n, 4, 3) ellipsoids, the centre and three orthogonal semi-axes.
    `blend` is the width of the smooth union. A `carve` part is subtracted.
    """

    pieces: np.ndarray
    blend: float
    carve: bool = False


# Distances of a piece at float32 coordinates that broadcast to a block of the grid.


def _cone(piece, x, y, z):
    (ax, ay, az, ar), (bx, by, bz, br) = piece.tolist()
    ux, uy, uz = bx - ax, by - ay, bz - az
    x, y, z = x - ax, y - ay, z - az
    t = np.clip((x * ux + y * uy + z * uz) / (ux * ux + uy * uy + uz * uz), 0, 1)
    return np.sqrt((x - t * ux) ** 2 + (y - t * uy) ** 2 + (z - t * uz) ** 2) - ar - t * (br - ar)


def _wedge(piece, x, y, z):
    (a, b, c), (ra, rb, rc) = piece[:, :3], piece[:, 3].tolist()
    normal = np.cross(b - a, c - a)
    normal /= np.linalg.norm(normal)
    # Barycentric weights of b and c, and the height above the plane, are linear in the point.
    rows = np.linalg.inv(np.stack([b - a, c - a, normal], axis=1)).tolist()
    ax, ay, az = a.tolist()
    v, w, height = (i * (x - ax) + j * (y - ay) + k * (z - az) for i, j, k in rows)
    slab = np.abs(height) - ra - v * (rb - ra) - w * (rc - ra)
    slab[(v < 0) | (w < 0) | (v + w > 1)] = _FAR
    edges = (_cone(piece[[i, i - 1]], x, y, z) for i in range(3))
    return np.minimum.reduce([slab, *edges])


def _ellipsoid(piece, x, y, z):
    # Quilez's first-order estimate k (k - 1) / |gradient of k^2 / 2|; exact enough near 0.
    cx, cy, cz = piece[0].tolist()
    axes = piece[1:] / (piece[1:] ** 2).sum(axis=1, keepdims=True)
    squares = [(i * (x - cx) + j * (y - cy) + k * (z - cz)) ** 2 for i, j, k in axes.tolist()]
    k = np.sqrt(sum(squares) + 1e-12)  # never 0: the centre would count as surface
    weights = (axes**2).sum(axis=1).tolist()
    slope = np.sqrt(sum(s * w for s, w in zip(squares, weights, strict=True)))
    return k * (k - 1) / np.maximum(slope, 1e-6)


_DISTANCES = {2: _cone, 3: _wedge, 4: _ellipsoid}


def _boxes(pieces: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Lowest and highest corners (n, 3) of the pieces' bounding boxes."""
    if pieces.shape[1] == 4:
        half = np.linalg.norm(pieces[:, 1:], axis=1)
        return pieces[:, 0] - half, pieces[:, 0] + half
    points, radii = pieces[..., :3], pieces[..., 3:]
    return (points - radii).min(axis=1), (points + radii).max(axis=1)


def distance_grid(parts: list[Part], cells: int) -> tuple[np.ndarray, np.ndarray, float]:
    """Signed distance to parts on a grid, its origin and cell size.

    float32, exact near the surface. A piece is evaluated only in its bounding box, widened by the reach
    of its blend.
    """
    boxes = [_boxes(part.pieces) for part in parts]
    low = np.min([lows.min(axis=0) for lows, _ in boxes], axis=0)
    high = np.max([highs.max(axis=0) for _, highs in boxes], axis=0)
    cell = float((high - low).max() / cells)
    origin = low - 4 * cell
    shape = np.ceil((high - low) / cell).astype(int) + 9
    lines = [
        (o + cell * np.arange(n)).astype(np.float32) for o, n in zip(origin, shape, strict=True)
    ]
    grid = np.full(shape, _FAR, np.float32)
    for part, (lows, highs) in zip(parts, boxes, strict=True):
        margin = part.blend + 3 * cell
        first = np.maximum(((lows - margin - origin) / cell).astype(int), 0)
        last = np.minimum(((highs + margin - origin) / cell).astype(int) + 2, shape)
        corner = first.min(axis=0)
        own = np.full(last.max(axis=0) - corner, _FAR, np.float32)
        pieces = part.pieces.copy()
        if pieces.shape[2] == 4:
            np.maximum(pieces[..., 3], MIN_RADIUS_CELLS * cell, out=pieces[..., 3])
        distance = _DISTANCES[pieces.shape[1]]
        for piece, start, stop in zip(pieces, first, last, strict=True):
            (i, j, k), (to_i, to_j, to_k) = start, stop
            axes = np.ix_(lines[0][i:to_i], lines[1][j:to_j], lines[2][k:to_k])
            block = own[tuple(map(slice, start - corner, stop - corner))]
            np.minimum(block, distance(piece, *axes), out=block)
        block = grid[tuple(map(slice, corner, last.max(axis=0)))]
        sign = -1 if part.carve else 1
        overlap = np.maximum(part.blend - np.abs(sign * block - own), 0)
        block[...] = sign * (np.minimum(sign * block, own) - overlap**2 / (4 * part.blend))
    return grid, origin, cell
