"""Shadow maps of a light at a place: one perspective picture, or the six of a cube.

Each texel holds the radial distance from the light to the first surface through its centre, in the
scene's unit; infinite where there is none. Maps are looked up by direction, so that filters go on
from one face of a cube to the next.
"""

from dataclasses import dataclass

import numpy as np
from numba import njit

from neural_shadows.scenes.tracing import Tracer

_RAYS = 1 << 18  # traced at once


@dataclass(frozen=True, eq=False)
class LightMap:
    """Geometry of a light's map; texel (face · N + row) · N + column."""

    centre: np.ndarray  # (3,) float64
    faces: np.ndarray  # (F, 3, 3) float64, rows right, down, forward of each
    half: float  # tangent of half a face's angle
    resolution: int  # N
    near: float = 0.0  # distance before which nothing lies

    @property
    def count(self) -> int:
        """Number of texels."""
        return len(self.faces) * self.resolution**2

    def texels_of(self, directions: np.ndarray) -> np.ndarray:
        """Texels of directions (n, 3) from the light, (n,) int64; −1 for none."""
        texels = np.empty(len(directions), np.int64)
        _fill_texels(directions, self.faces, self.half, self.resolution, texels)
        return texels

    def places_of(self, directions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Faces (n,) int64 of directions (n, 3), −1 for none, and places.

        Places are (n, 2) float64, row and column in texels from the face's upper left corner.
        """
        faces = np.empty(len(directions), np.int64)
        places = np.empty((len(directions), 2))
        _fill_places(directions, self.faces, self.half, self.resolution, faces, places)
        return faces, places

    def directions_of(self, texels: np.ndarray) -> np.ndarray:
        """Unit directions (t, 3) float32 through the centres of texels (t,)."""
        directions = np.empty((len(texels), 3), np.float32)
        _fill_directions(texels, self.faces, self.half, self.resolution, directions)
        return directions

    def depths(self, tracer: Tracer, texels: np.ndarray | None = None) -> np.ndarray:
        """Distances in texels (t,) float32, of all by default."""
        return self.first_hits(tracer, np.arange(self.count) if texels is None else texels)[0]

    def first_hits(self, tracer: Tracer, texels: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Distances in texels (t,) float32, and faces hit, int32; −1 for none."""
        depths, faces = np.empty(len(texels), np.float32), np.empty(len(texels), np.int32)
        origins = np.broadcast_to(self.centre.astype(np.float32), (_RAYS, 3)).copy()
        for begin in range(0, len(texels), _RAYS):
            part = slice(begin, begin + _RAYS)
            directions = self.directions_of(texels[part])
            depths[part], faces[part] = tracer.first_hit(origins[: len(directions)], directions)
        return depths, faces

    def widened(self, face: int, margin: int) -> "LightMap":
        """One face with a margin of texels on each side."""
        resolution = self.resolution + 2 * margin
        half = self.half * resolution / self.resolution
        return LightMap(self.centre, self.faces[face : face + 1], half, resolution, self.near)

    def texel_size(self, directions: np.ndarray) -> np.ndarray:
        """A texel's side at distance 1, across a direction (n, 3): (n,) float32.

        Off a face's middle it is smaller: at a cube's edge 0.71 of it, the longer of the texel's sides, at
        its corner 0.58, where both sides are 0.47.
        """
        sizes = np.empty(len(directions), np.float32)
        _fill_sizes(directions, self.faces[:, 2], 2 * self.half / self.resolution, sizes)
        return sizes


def cube_map(centre: np.ndarray, resolution: int) -> LightMap:
    """Six faces along the axes, all round a light."""
    faces = []
    for axis in range(3):
        for sign in (1, -1):
            forward = sign * np.eye(3)[axis]
            right = np.eye(3)[(axis + 1) % 3]
            faces.append([right, np.cross(forward, right), forward])
    return LightMap(np.asarray(centre, np.float64), np.array(faces), 1.0, resolution)


def perspective_map(
    centre: np.ndarray, forward: np.ndarray, fov: float, resolution: int, near: float = 0.0
) -> LightMap:
    """One face along `forward`; `fov`: its whole angle in degrees."""
    forward = np.asarray(forward, np.float64) / np.linalg.norm(forward)
    right = np.cross(forward, np.eye(3)[np.argmin(np.abs(forward))])
    right /= np.linalg.norm(right)
    face = [right, np.cross(forward, right), forward]
    half = float(np.tan(np.radians(fov) / 2))
    return LightMap(np.asarray(centre, np.float64), np.array([face]), half, resolution, near)


@njit(cache=True, nogil=True, inline="always")
def place_of(x, y, z, faces, half, resolution):
    """Face of a direction, or −1, and its row and column in texels."""
    best, along = -1, 0.0
    for face in range(len(faces)):
        forward = faces[face, 2, 0] * x + faces[face, 2, 1] * y + faces[face, 2, 2] * z
        if forward > along:
            best, along = face, forward
    if best < 0:
        return -1, 0.0, 0.0
    scale = 0.5 * resolution / (half * along)
    right = faces[best, 0, 0] * x + faces[best, 0, 1] * y + faces[best, 0, 2] * z
    down = faces[best, 1, 0] * x + faces[best, 1, 1] * y + faces[best, 1, 2] * z
    column, row = right * scale + 0.5 * resolution, down * scale + 0.5 * resolution
    if len(faces) < 6 and not (0 <= column < resolution and 0 <= row < resolution):
        return -1, 0.0, 0.0
    return best, row, column


@njit(cache=True, nogil=True, inline="always")
def texel_of(x, y, z, faces, half, resolution):
    """Texel of a direction, or −1."""
    face, row, column = place_of(x, y, z, faces, half, resolution)
    if face < 0:
        return -1
    # Rounding at an edge of the cube.
    row = min(max(int(np.floor(row)), 0), resolution - 1)
    column = min(max(int(np.floor(column)), 0), resolution - 1)
    return (face * resolution + row) * resolution + column


@njit(cache=True, nogil=True)
def _fill_texels(directions, faces, half, resolution, texels):
    for i in range(len(directions)):
        x, y, z = directions[i, 0], directions[i, 1], directions[i, 2]
        texels[i] = texel_of(x, y, z, faces, half, resolution)


@njit(cache=True, nogil=True)
def _fill_places(directions, faces, half, resolution, into, places):
    for i in range(len(directions)):
        x, y, z = directions[i, 0], directions[i, 1], directions[i, 2]
        into[i], places[i, 0], places[i, 1] = place_of(x, y, z, faces, half, resolution)


@njit(cache=True, nogil=True)
def _fill_sizes(directions, forwards, middle, sizes):
    for i in range(len(directions)):
        along = 1e-3
        for face in range(len(forwards)):
            x, y, z = forwards[face]
            dot = x * directions[i, 0] + y * directions[i, 1] + z * directions[i, 2]
            along = max(along, dot)
        sizes[i] = middle * along


@njit(cache=True, nogil=True)
def _fill_directions(texels, faces, half, resolution, directions):
    for i in range(len(texels)):
        row, column = texels[i] // resolution, texels[i] % resolution
        right, down, forward = faces[row // resolution]
        x = (2 * (column + 0.5) / resolution - 1) * half
        y = (2 * (row % resolution + 0.5) / resolution - 1) * half
        length = np.sqrt(1 + x * x + y * y)
        for k in range(3):
            directions[i, k] = (forward[k] + x * right[k] + y * down[k]) / length
