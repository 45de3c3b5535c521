"""The cameras and lights of the evaluation frames, drawn at random from one seed [4.1]."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from neural_shadows.errors import InputError
from neural_shadows.meshes.prepared_mesh import PreparedMesh
from neural_shadows.rendering.gbuffer import ground_height, primary_hits
from neural_shadows.rendering.shading import reference_visibility, visibility
from neural_shadows.scenes.cameras import Viewpoint, camera_axes
from neural_shadows.scenes.lights import draw_light, light_basis
from neural_shadows.scenes.tracing import Tracer

VIEW_SETS = ("shadow", "surface", "centre")
FOV = 45.0
# A candidate is judged by a picture of this many rows; of the candidates drawn, the first that
# is good enough is taken, or else the best.
_PROBE_ROWS = 24
_CANDIDATES = 48


@dataclass(frozen=True, eq=False)
class _Scene:
    mesh: PreparedMesh
    tracer: Tracer
    up: np.ndarray
    ground: float | None
    aspect: float
    cumulative_area: np.ndarray  # (F,) of the faces


def draw_viewpoints(
    mesh: PreparedMesh,
    tracer: Tracer,
    *,
    up: np.ndarray,
    ground: bool,
    light_domain: dict,
    view_sets: Iterable[str],
    indices: Iterable[int],
    width: int,
    height: int,
    seed: int,
) -> list[Viewpoint]:
    """Viewpoints number `indices` of each of `view_sets`, in that order [4.1].

    A viewpoint depends on the scene, the aspect ratio, `seed`, its set and its number alone:
    sets can be drawn in batches, and more viewpoints leave the earlier ones as they were.

    `shadow`: at the shadow cast on the ground, which fills about half of the frame, from where
    the object hides little of it.
    `surface`: at a visible point of the object's surface that is turned to the light.
    `centre`: at the centre of the bounding sphere, from 20 to 70 degrees above.

    Args:
        up: (3,) unit vector.
        ground: whether a ground plane lies under the object.
        light_domain: see `draw_light`; each viewpoint draws its own light.
        width, height: pixels of the frames to come.

    Raises:
        InputError: a set is unknown, or `shadow` is asked of a scene without ground, or
            `surface` of one whose light reaches none; a value of `light_domain` is wrong.
    """
    view_sets = tuple(view_sets)
    for view_set in view_sets:
        if view_set not in VIEW_SETS:
            raise InputError(f"view_sets: {view_set!r} is unknown; use {', '.join(VIEW_SETS)}")
        if view_set == "shadow" and not ground:
            raise InputError("view_sets: shadow needs a ground; drop it, or set ground: true")
    a, b, c = (mesh.vertices[mesh.faces[:, k]] for k in range(3))
    scene = _Scene(
        mesh,
        tracer,
        np.asarray(up, np.float64),
        ground_height(mesh, up) if ground else None,
        width / height,
        np.cumsum(np.linalg.norm(np.cross(b - a, c - a), axis=1), dtype=np.float64),
    )
    draw = {"shadow": _draw_shadow, "surface": _draw_surface, "centre": _draw_centre}
    indices = tuple(indices)
    viewpoints = []
    for view_set in view_sets:
        for index in indices:
            key = (VIEW_SETS.index(view_set), index)
            rng = np.random.default_rng(np.random.SeedSequence(seed, spawn_key=key))
            light = draw_light(light_domain, scene.up, rng)
            eye, target = draw[view_set](scene, light, rng)
            viewpoints.append(Viewpoint(view_set, index, eye, target, scene.up, FOV, light))
    return viewpoints


def surface_points(
    mesh: PreparedMesh, cumulative_area: np.ndarray, count: int, rng: np.random.Generator
) -> tuple[np.ndarray, np.ndarray]:
    """Points uniform over the surface, and the normals of their faces: (count, 3) each.

    Args:
        cumulative_area: (F,) running sum of the faces' areas, in any unit.
    """
    where = rng.uniform(0, cumulative_area[-1], count)
    face = np.minimum(np.searchsorted(cumulative_area, where), len(cumulative_area) - 1)
    a, b, c = (mesh.vertices[mesh.faces[face, k]].astype(np.float64) for k in range(3))
    # The square root spreads points evenly over a triangle (Turk 1990).
    s, t = np.sqrt(rng.uniform(size=(count, 1))), rng.uniform(size=(count, 1))
    return (1 - s) * a + s * (1 - t) * b + s * t * c, mesh.face_normals[face]


def _direction_above(up: np.ndarray, lowest: float, highest: float, rng: np.random.Generator):
    """Unit vector (3,), uniform by area between two elevations in degrees."""
    sine = rng.uniform(np.sin(np.radians(lowest)), np.sin(np.radians(highest)))
    azimuth = rng.uniform(0, 2 * np.pi)
    cosine = np.sqrt(1 - sine**2)
    return np.array([cosine * np.cos(azimuth), cosine * np.sin(azimuth), sine]) @ light_basis(up)


def _shares(scene: _Scene, eye: np.ndarray, target: np.ndarray, light: np.ndarray):
    """Shares of a frame's pixels that show the shadow cast on the ground, and the object."""
    view = Viewpoint("", 0, eye, target, scene.up, FOV, light)
    width = round(_PROBE_ROWS * scene.aspect)
    points = primary_hits(scene.mesh, scene.tracer, view, width, _PROBE_ROWS, scene.ground)
    dark = ~visibility(points, reference_visibility(scene.tracer, points))
    pixels = width * _PROBE_ROWS
    return np.count_nonzero(dark & ~points.is_object) / pixels, points.is_object.sum() / pixels


def _draw_shadow(scene: _Scene, light: np.ndarray, rng: np.random.Generator):
    points, _ = surface_points(scene.mesh, scene.cumulative_area, 256, rng)
    drop = (points @ scene.up - scene.ground) / (light @ scene.up)
    shadow = points - drop[:, None] * light
    best = -np.inf
    for _ in range(_CANDIDATES):
        direction = _direction_above(scene.up, 20, 75, rng)
        # On the way from the middle of the shadow to any point of it: varied, yet seldom its rim.
        middle, other = shadow.mean(0), shadow[rng.integers(len(shadow))]
        target = middle + rng.uniform() * (other - middle)
        right, upward, _ = camera_axes(target + direction, target, scene.up)
        extent = np.abs((shadow - target) @ np.stack([right, upward], axis=1))
        across, along = np.quantile(extent, 0.9, axis=0)
        fitting = max(across / scene.aspect, along) / np.tan(np.radians(FOV / 2))
        eye = target + rng.uniform(0.5, 1.2) * fitting * direction
        cast, occluder = _shares(scene, eye, target, light)
        # Ideal: half the frame in shadow, which has the most outline, and no object in it.
        fitness = -abs(cast - 0.5) - 1.5 * occluder
        if fitness > best:
            best, chosen = fitness, (eye, target)
        if fitness > -0.2:
            break
    return chosen


def _draw_surface(scene: _Scene, light: np.ndarray, rng: np.random.Generator):
    best = -np.inf
    for _ in range(_CANDIDATES):
        eye, target = _see_surface(scene, light, rng)
        _, share = _shares(scene, eye, target, light)
        if share > best:
            best, chosen = share, (eye, target)
        if share >= 0.4:
            break
    return chosen


def _see_surface(scene: _Scene, light: np.ndarray, rng: np.random.Generator):
    """Eye outside the bounding sphere and target on the surface, with nothing between them."""
    for _ in range(1000):  # on the dragon one in six will do
        points, normals = surface_points(scene.mesh, scene.cumulative_area, 1, rng)
        target, normal = points[0], normals[0]
        direction = _direction_above(scene.up, 5, 80, rng)
        # Either side of the face: an object hides its own inside, and an open sheet has none.
        cosine = normal @ direction
        # Seen from within 73 degrees of its normal, and turned to the light: elsewhere every
        # method is dark, and nothing would be compared.
        if abs(cosine) < 0.3 or (normal @ light) * cosine <= 0:
            continue
        eye = target + rng.uniform(0.9, 2.3) * direction
        if np.linalg.norm(eye) < 1.1:
            continue
        ray = (target - eye).astype(np.float32)[None]
        t, _ = scene.tracer.first_hit(eye.astype(np.float32)[None], ray)
        if 0.999 < t[0] < np.inf:
            return eye, target
    raise InputError(
        "view_sets: surface: no point of the object is both lit and seen from above; "
        "check the mesh, the scene's up and its light"
    )


def _draw_centre(scene: _Scene, light: np.ndarray, rng: np.random.Generator):
    direction = _direction_above(scene.up, 20, 70, rng)
    return rng.uniform(1.1, 1.8) * direction, np.zeros(3)
