"""Surfaces seen by a camera, independent of lights."""

from dataclasses import dataclass

import numpy as np

from neural_shadows.rendering.gbuffer import interpolate, pixel_directions
from neural_shadows.rendering.lengths import lengths_of
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
    corners = np.take(mesh.faces, face, axis=0).T
    n_g = np.take(mesh.face_normals, face, axis=0)
    n = interpolate(mesh.vertex_normals, corners, u, v)
    averted = np.einsum("ij,ij->i", n_g, np.take(directions, pixel, axis=0)) > 0
    n_g = np.where(averted[:, None], -n_g, n_g)
    # On its own face's side, as `render_gbuffer` has it.
    opposed = np.einsum("ij,ij->i", n, n_g) < 0
    n = np.where(opposed[:, None], -n, n)
    n /= np.maximum(lengths_of(n)[:, None], np.float32(1e-12))
    p = interpolate(mesh.vertices, corners, u, v)
    return Surface(camera, width, height, pixel, face, p, n_g, n)
