"""G-buffers: surface points, and those facing the light."""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from neural_shadows.rendering.lengths import lengths_of
from neural_shadows.scenes.cameras import Camera, Viewpoint, Window, camera_axes
from neural_shadows.scenes.scene import Scene

# Every method shades p + SHADING_OFFSET n_g (normalised space): some 10,000 float32 roundings,
# so that no ray meets its own triangle, and 1/2000 of the object.
SHADING_OFFSET = 1e-3
# The ground is a disc round the object's foot, wide enough to be the horizon of most frames.
GROUND_RADIUS = 20.0


@dataclass(frozen=True, eq=False)
class GBuffer:
    """A frame's n surface points, m of them facing the light.

    Points with n_g·l ≤ 0 are dark in every method, so that only the m others, on the lit side, are
    queried. A shadow method returns a visibility in [0, 1] of all n.
    """

    view: Viewpoint
    width: int
    height: int
    pixel: np.ndarray  # (n,) int64, row · width + column of each pixel that shows a surface
    is_object: np.ndarray  # (n,) bool, the object (True) or the ground
    lit_side: np.ndarray  # (m,) int64, indices into the n points
    p: np.ndarray  # (m, 3) float32, already moved by SHADING_OFFSET n_g
    cos_geometric: np.ndarray  # (m,) float32, n_g·l > 0 of the face's normal on the camera's side
    cos_shading: np.ndarray  # (m,) float32, max(0, n·l) of the interpolated normal n

    def visibility(self, lit: np.ndarray) -> np.ndarray:
        """Visibility (n,) float32 from the lit side's (m,); elsewhere 0."""
        visible = np.zeros(len(self.pixel), np.float32)
        visible[self.lit_side] = lit
        return visible


def pixel_directions(
    view: Camera, width: int, height: int, place: tuple[float, float] = (0.5, 0.5)
) -> np.ndarray:
    """Rays through a place in each pixel, (height · width, 3) float32.

    Rows from the top; their length along the camera's axis is 1. The place is from the pixel's left and top.
    """
    right, upward, forward = camera_axes(view.eye, view.target, view.up)
    half = np.tan(np.radians(view.fov) / 2)
    whole = view.window or Window(width, height, 0, 0)
    columns, rows = np.arange(width) + whole.left, np.arange(height) + whole.top
    x = (2 * (columns + place[0]) / whole.full_width - 1) * half
    x = x * whole.full_width / whole.full_height
    y = (1 - 2 * (rows + place[1]) / whole.full_height) * half
    directions = np.empty((height, width, 3), np.float32)
    for k in range(3):  # by component: a broadcast over a last axis of 3 is several times slower
        column = (forward[k] + y * upward[k]).astype(np.float32)
        np.add(column[:, None], (x * right[k]).astype(np.float32), out=directions[..., k])
    return directions.reshape(-1, 3)


class Lens(NamedTuple):
    """An image's `axis_cosines` (H, W) float32, and focal length in pixels."""

    axis: np.ndarray
    focal: float


def lens_of(camera: Camera, width: int, height: int) -> Lens:
    """The lens of a camera's image."""
    return Lens(axis_cosines(camera, width, height), camera.focal(height))


def axis_cosines(camera: Camera, width: int, height: int) -> np.ndarray:
    """Cosines of pixels' rays with the camera's axis, (height, width) float32.

    A distance from the eye times its cosine is the depth along the axis.
    """
    directions = pixel_directions(camera, width, height)  # 1 long along the axis
    return (1 / lengths_of(directions)).reshape(height, width)


def _dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.einsum("ij,ij->i", a, b)


def render_gbuffer(scene: Scene, view: Viewpoint, width: int, height: int) -> GBuffer:
    """Trace pixel centres and prepare the surface points for shading.

    The eye must be above the ground and the object on it, so that a ray meets the object first.
    """
    (mesh,) = scene.objects
    light = view.light.astype(np.float32)
    directions = pixel_directions(view, width, height)
    eye = view.eye.astype(np.float32)
    hit, face, u, v = scene.tracer.first_hit_barycentric(
        np.tile(eye, (len(directions), 1)), directions
    )

    # np.take throughout: on rows of three it is ten times as fast as an index in brackets.
    pixel = np.flatnonzero(hit)
    face, u, v = face[pixel], u[pixel], v[pixel]
    n_g = np.take(mesh.face_normals, face, axis=0)
    # Both normals are turned by the geometric one: the far side of an open sheet is shaded too.
    side = -np.sign(_dot(n_g, np.take(directions, pixel, axis=0)))
    cos_geometric = side * (n_g @ light)
    lit_side = np.flatnonzero(cos_geometric > 0)
    side, cos_geometric, u, v = side[lit_side], cos_geometric[lit_side], u[lit_side], v[lit_side]
    corners = np.take(mesh.faces, face[lit_side], axis=0).T
    # From the triangle and not from t, whose rounding grows with the distance of the eye.
    p = interpolate(mesh.vertices, corners, u, v)
    n_g = np.take(n_g, lit_side, axis=0)
    p += (np.float32(SHADING_OFFSET) * side)[:, None] * n_g
    n = interpolate(mesh.vertex_normals, corners, u, v)
    # The normal is turned to its own face's side: the Stanford dragon has 1,329 flaps of two
    # opposite faces, one of them removed, and where the inner one is left the vertices'
    # normals oppose it: dark speckles, 264 pixels in 12 frames, in all methods alike.
    side *= np.where(_dot(n, n_g) < 0, np.float32(-1), np.float32(1))
    cos_shading = side * (n @ light) / np.maximum(np.sqrt(_dot(n, n)), np.float32(1e-12))

    frame = GBuffer(
        view=view,
        width=width,
        height=height,
        pixel=pixel,
        is_object=np.ones(len(pixel), bool),
        lit_side=lit_side,
        p=p,
        cos_geometric=cos_geometric,
        cos_shading=np.maximum(cos_shading, 0),
    )
    if scene.ground is None:
        return frame
    return with_ground(frame, *_ground_hits(view, directions, width, hit, scene.ground))


def with_ground(frame: GBuffer, pixel: np.ndarray, p: np.ndarray) -> GBuffer:
    """Append g points of the ground to a frame.

    Args:
        pixel: (g,) int64, their pixels; p: (g, 3) float32, see `ground_points`.
    """
    own = len(frame.pixel)
    up = frame.view.up
    cos = np.full(len(pixel), up @ frame.view.light, np.float32)
    return replace(
        frame,
        pixel=np.concatenate([frame.pixel, pixel]),
        is_object=np.arange(own + len(pixel)) < own,
        lit_side=np.concatenate([frame.lit_side, np.arange(own, own + len(pixel))]),
        p=np.concatenate([frame.p, p + np.float32(SHADING_OFFSET) * up.astype(np.float32)]),
        cos_geometric=np.concatenate([frame.cos_geometric, cos]),
        cos_shading=np.concatenate([frame.cos_shading, cos]),
    )


def interpolate(values: np.ndarray, corners: np.ndarray, u: np.ndarray, v: np.ndarray):
    """Interpolate values (V, 3) at `corners` (3, n), weights u, v: (n, 3)."""
    result = (1 - u - v)[:, None] * np.take(values, corners[0], axis=0)
    result += u[:, None] * np.take(values, corners[1], axis=0)
    result += v[:, None] * np.take(values, corners[2], axis=0)
    return result


def _ground_hits(
    view: Viewpoint, directions: np.ndarray, width: int, hit: np.ndarray, ground: float
):
    """Pixels (g,) of the ground's disc, and its points (g, 3)."""
    descends = np.repeat(_slopes(view, directions, width) < 0, width)
    pixel = np.flatnonzero(descends & ~hit)
    p = _on_plane(view, directions, width, pixel, ground)
    inside = np.flatnonzero(_dot(p, p) < GROUND_RADIUS**2 + ground**2)
    return pixel[inside], np.take(p, inside, axis=0)


def ground_points(
    view: Viewpoint, width: int, height: int, pixel: np.ndarray, ground: float
) -> np.ndarray:
    """Intersect the rays of ground pixels (g,) with it: (g, 3) float32."""
    return _on_plane(view, pixel_directions(view, width, height), width, pixel, ground)


def _slopes(view: Viewpoint, directions: np.ndarray, width: int) -> np.ndarray:
    """Slopes of the rays of each row: (height,); the camera has no roll."""
    return directions[::width] @ view.up.astype(np.float32)


def _on_plane(
    view: Viewpoint, directions: np.ndarray, width: int, pixel: np.ndarray, ground: float
) -> np.ndarray:
    slope = np.minimum(_slopes(view, directions, width), np.float32(-1e-30))
    t = np.float32(ground - view.eye @ view.up) / slope
    p = np.take(directions, pixel, axis=0)
    p *= np.take(t, pixel // width)[:, None]
    p += view.eye.astype(np.float32)
    return p
