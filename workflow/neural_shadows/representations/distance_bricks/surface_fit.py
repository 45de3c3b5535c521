"""Signed distances fitted to shadow boundaries.

Where a shadow ends, a ray touches the mesh, and of a mesh of triangles it touches a convex edge.
Interpolated distances cut these edges off: of the Stanford dragon at 256³ by 0.05 of a cell. So the
values are those with the least squares of the field at points on the edges, each weighed by
how many rays touch the edge there: its length times its outer angle, which for lines of all
directions is their measure (Santaló 1976, Integral geometry and geometric probability).
"""

from collections.abc import Iterator
from itertools import chain

import numpy as np
from numba import njit
from scipy.sparse.linalg import LinearOperator, cg

from neural_shadows.meshes.prepared_mesh import PreparedMesh
from neural_shadows.meshes.sides import sides_by_edges
from neural_shadows.representations.distance_bricks.brick_layout import BrickLayout
from neural_shadows.representations.distance_bricks.field_marching import BRICK

# Pooled PSNR of the Stanford dragon at 256³, not quantised, with distances 39.2 dB: 42.6 as here;
# 42.5 with a third of FACES and a fifth of HELD; 42.4 where concave edges weigh 0.3 of convex ones;
# 42.5 for absolute values in place of squares; 42.6 after 20 steps.
SAMPLES_PER_CELL = 2  # along an edge
FACES = 0.1  # weight of a face, by its area in cells: a lit surface must not shadow itself
HELD = 0.1  # weight of a vertex's own distance, in mean sample weights
OUT = 0.05  # initial offset outwards in cells: few steps change smooth parts
STEPS = 10  # of conjugate gradients


_CHUNK = 1 << 18  # edges or faces whose points are held at once
# Places in a cell's products of two corners, by rows.
_PRODUCTS = 8 * 9 // 2


def fitted_distances(mesh: PreparedMesh, layout: BrickLayout, distances: np.ndarray) -> np.ndarray:
    """Field values (count,) float32 with the surface closest to convex edges.

    Args:
        mesh: a solid.
        distances: of `signed_distances`, (count,) float32 in cells, positive inside.
    """
    columns, products, mean_weight = _weighed_products(mesh, layout)
    held = np.float32(HELD * mean_weight)
    start = distances + np.float32(OUT)
    diagonal = _diagonal(columns, products, layout.count) + held
    shape = (layout.count,) * 2
    squares = LinearOperator(
        shape, lambda x: _times(columns, products, x) + held * x, dtype=np.float32
    )
    scaled = LinearOperator(shape, lambda x: x / diagonal, dtype=np.float32)
    change, _ = cg(squares, -_times(columns, products, start), maxiter=STEPS, M=scaled)
    return (start + change).astype(np.float32)


def _weighed_products(
    mesh: PreparedMesh, layout: BrickLayout
) -> tuple[np.ndarray, np.ndarray, float]:
    """Sums over points of weights times shares of two corners, by cells, and the mean weight.

    Of so many cells as hold points, for any number of points.

    Returns:
        columns: (cells, 8) int32, indices of the corners' values.
        products: (cells, 36) float32, of corners i and j ≥ i, by rows.
    """
    half = len(layout.grid) * BRICK / 2  # cells in a radius
    numbers = np.full((len(layout.table), BRICK**3), -1, np.int32)
    columns = np.empty((_CHUNK, 8), np.int32)
    products = np.zeros((_CHUNK, _PRODUCTS), np.float32)
    cells, points, total = 0, 0, 0.0
    for positions, weights in chain(_edges(mesh, half), _faces(mesh, half)):
        if cells + len(positions) > len(columns):
            more = max(len(columns), len(positions))
            columns = np.pad(columns, [(0, more), (0, 0)])
            products = np.pad(products, [(0, more), (0, 0)])
        sums = numbers, columns, products
        cells = _add_points(positions, weights, half, layout.grid, layout.table, *sums, cells)
        points, total = points + len(weights), total + float(weights.sum())
    return columns[:cells], products[:cells], total / max(points, 1)


def _edges(mesh: PreparedMesh, half: float) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Points (n, 3) float32 on convex edges, and their weights (n,) float32, by parts."""
    all_ends, all_angles = convex_edges(mesh)
    for first in range(0, len(all_ends), _CHUNK):
        ends, angles = all_ends[first : first + _CHUNK], all_angles[first : first + _CHUNK]
        a, b = mesh.vertices[ends[:, 0]], mesh.vertices[ends[:, 1]]
        length = np.linalg.norm(a - b, axis=1) * half
        count = np.ceil(length * SAMPLES_PER_CELL).astype(np.int64)
        edge = np.repeat(np.arange(len(ends)), count)
        number = np.arange(len(edge)) - np.repeat(np.cumsum(count) - count, count)
        t = ((number + 0.5) / count[edge]).astype(np.float32)[:, None]
        weights = (length * angles / np.maximum(count, 1))[edge]
        yield a[edge] * (1 - t) + b[edge] * t, weights.astype(np.float32)


def _faces(mesh: PreparedMesh, half: float) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Middles (n, 3) float32 and weights (n,) float32 of faces, by parts."""
    for first in range(0, len(mesh.faces), _CHUNK):
        corners = mesh.vertices[mesh.faces[first : first + _CHUNK]]
        across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        area = np.linalg.norm(across, axis=1) / 2 * half**2
        yield corners.mean(axis=1), (FACES * area).astype(np.float32)


def convex_edges(mesh: PreparedMesh) -> tuple[np.ndarray, np.ndarray]:
    """Vertices (n, 2) int32 and outer angles (n,) float32 in radians of convex edges.

    An edge of one face has π: rays of all directions touch it.
    """
    sides = 3 * len(mesh.faces)
    ends, angles = np.empty((sides, 2), np.int32), np.empty(sides, np.float32)
    arrays = mesh.vertices, mesh.faces, mesh.face_normals
    count = _find_convex(*arrays, *sides_by_edges(mesh.faces, len(mesh.vertices)), ends, angles)
    return ends[:count].copy(), angles[:count].copy()


@njit(cache=True, nogil=True)
def _find_convex(vertices, faces, normals, firsts, sides, others, ends, angles):
    """Fill in `ends` and `angles`; return the number of edges."""
    count = 0
    for vertex in range(len(firsts) - 1):
        start, end = firsts[vertex], firsts[vertex + 1]
        for n in range(start, end):
            angle = np.pi
            if n + 1 < end and others[n + 1] == others[n]:
                angle = _outer_angle(vertices, faces, normals, sides[n], sides[n + 1])
            elif n > start and others[n - 1] == others[n]:
                continue
            if angle >= 0:
                ends[count, 0], ends[count, 1], angles[count] = vertex, others[n], angle
                count += 1
    return count


@njit(cache=True, nogil=True)
def _outer_angle(vertices, faces, normals, first, second):
    """Angle between two faces in radians; −1 where they meet concavely."""
    f, g, opposite = first // 3, second // 3, faces[second // 3, (second + 2) % 3]
    start = faces[f, first % 3]
    height, cosine = 0.0, 0.0
    for axis in range(3):
        height += (vertices[opposite, axis] - vertices[start, axis]) * normals[f, axis]
        cosine += normals[f, axis] * normals[g, axis]
    return np.arccos(min(max(cosine, -1.0), 1.0)) if height < 0 else -1.0


@njit(cache=True, nogil=True)
def _add_points(points, weights, half, grid, table, numbers, columns, products, cells):
    """Add points (n, 3) to their cells' products; return the number of cells.

    A point on a border that rounding moves out of its brick is left out.

    Args:
        numbers: (bricks, 64) int32, of each cell, or −1.
    """
    one, half = np.float32(1), np.float32(half)
    most = np.float32(len(grid) * BRICK - 1e-3)
    cell, part, shares = np.empty(3, np.int64), np.empty(3, np.float32), np.empty(8, np.float32)
    for n in range(len(points)):
        for axis in range(3):
            position = min(max((points[n, axis] + one) * half, np.float32(0)), most)
            cell[axis] = int(position)
            part[axis] = position - np.float32(cell[axis])
        brick = grid[cell[0] // BRICK, cell[1] // BRICK, cell[2] // BRICK]
        if brick < 0:
            continue
        x, y, z = cell[0] % BRICK, cell[1] % BRICK, cell[2] % BRICK
        number = numbers[brick, (x * BRICK + y) * BRICK + z]
        if number < 0:
            number = numbers[brick, (x * BRICK + y) * BRICK + z] = cells
            cells += 1
            for c in range(8):
                i, j, k = c >> 2, c >> 1 & 1, c & 1
                at = ((x + i) * (BRICK + 1) + y + j) * (BRICK + 1) + z + k
                columns[number, c] = table[brick, at]
        for c in range(8):
            share = part[0] if c >> 2 else one - part[0]
            share *= part[1] if c >> 1 & 1 else one - part[1]
            shares[c] = share * (part[2] if c & 1 else one - part[2])
        at = 0
        for c in range(8):
            weighed = weights[n] * shares[c]
            for e in range(c, 8):
                products[number, at] += weighed * shares[e]
                at += 1
    return cells


@njit(cache=True, nogil=True)
def _times(columns, products, x):
    """Product of the matrix of all cells' products with values (count,) float32."""
    result, values = np.zeros(len(x), np.float32), np.empty(8, np.float32)
    sums = np.empty(8, np.float32)
    for n in range(len(columns)):
        for c in range(8):
            values[c], sums[c] = x[columns[n, c]], 0
        at = 0
        for c in range(8):
            sums[c] += products[n, at] * values[c]
            at += 1
            for e in range(c + 1, 8):
                sums[c] += products[n, at] * values[e]
                sums[e] += products[n, at] * values[c]
                at += 1
        for c in range(8):
            result[columns[n, c]] += sums[c]
    return result


@njit(cache=True, nogil=True)
def _diagonal(columns, products, count):
    """Diagonal (count,) float32 of the matrix of all cells' products."""
    result = np.zeros(count, np.float32)
    for n in range(len(columns)):
        at = 0
        for c in range(8):
            result[columns[n, c]] += products[n, at]
            at += 8 - c
    return result
