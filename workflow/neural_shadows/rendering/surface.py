"""Surfaces seen by a camera, independent of lights."""

from dataclasses import dataclass

import numpy as np
from numba import njit

from neural_shadows.rendering.gbuffer import pixel_directions
from neural_shadows.scenes.cameras import Camera, camera_axes
from neural_shadows.scenes.scene import Scene


@dataclass(frozen=True, eq=False)
class Surface:
    """The surface at one place of each pixel; lengths in the scene's unit.

    Normals are on the camera's side: both sides of an open sheet are shaded.
    """

    camera: Camera
    width: int
    height: int
    pixel: np.ndarray  # (n,) int64, row · width + column of each pixel with a surface
    face: np.ndarray  # (n,) int32, of the scene's joined mesh
    p: np.ndarray  # (n, 3) float32, on the surface
    n_g: np.ndarray  # (n, 3) float32, the face's unit normal
    n: np.ndarray  # (n, 3) float32, the interpolated unit normal

    def image(self, values: np.ndarray, empty: float = 0.0) -> np.ndarray:
        """Image (height, width, …) of the points' values (n, …); else `empty`."""
        whole = np.full((self.height * self.width, *values.shape[1:]), empty, values.dtype)
        whole[self.pixel] = values
        return whole.reshape(self.height, self.width, *values.shape[1:])

    def depth_image(self) -> np.ndarray:
        """Depths along the camera's axis, (height, width) float32; 0 if empty."""
        camera = self.camera
        forward = camera_axes(camera.eye, camera.target, camera.up)[2].astype(np.float32)
        return self.image((self.p - camera.eye.astype(np.float32)) @ forward)


def see_surface(
    scene: Scene, camera: Camera, width: int, height: int, place: tuple[float, float] = (0.5, 0.5)
) -> Surface:
    """Trace one ray through each pixel.

    Args:
        place: where in the pixel, from its left and its top, in pixels.
    """
    mesh = scene.joined
    directions = pixel_directions(camera, width, height, place)
    eye = np.tile(camera.eye.astype(np.float32), (len(directions), 1))
    hit, face, u, v = scene.tracer.first_hit_barycentric(eye, directions)
    pixel = np.flatnonzero(hit)
    face, u, v = face[pixel], u[pixel], v[pixel]
    p, n_g, n = np.empty((3, len(pixel), 3), np.float32)
    _fill_points(
        mesh.vertices, mesh.vertex_normals, mesh.face_normals, mesh.faces,
        directions, pixel, face, u, v, p, n_g, n,
    )  # fmt: skip
    return Surface(camera, width, height, pixel, face, p, n_g, n)


@njit(cache=True, nogil=True, error_model="numpy")
def _fill_points(
    vertices, normals, face_normals, faces, directions, pixel, face, u, v, p, n_g, n
):  # fmt: skip
    """Points (n, 3) and both their normals, in a third of the time of numpy's functions."""
    one, least = np.float32(1), np.float32(1e-12)
    for i in range(len(pixel)):
        a, b, c = faces[face[i]]
        first = one - u[i] - v[i]
        averted = opposed = squared = np.float32(0)
        for k in range(3):
            p[i, k] = first * vertices[a, k] + u[i] * vertices[b, k] + v[i] * vertices[c, k]
            n[i, k] = first * normals[a, k] + u[i] * normals[b, k] + v[i] * normals[c, k]
            n_g[i, k] = face_normals[face[i], k]
            averted += n_g[i, k] * directions[pixel[i], k]
        for k in range(3):
            n_g[i, k] = -n_g[i, k] if averted > 0 else n_g[i, k]
            opposed += n[i, k] * n_g[i, k]
            squared += n[i, k] * n[i, k]
        # On its own face's side, as `render_gbuffer` has it.
        length = max(np.sqrt(squared), least)
        for k in range(3):
            n[i, k] = (-n[i, k] if opposed < 0 else n[i, k]) / length
