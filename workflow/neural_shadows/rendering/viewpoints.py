"""Random cameras and lights of the evaluation frames [4.1]."""

from collections.abc import Iterable

import numpy as np

from neural_shadows.errors import InputError
from neural_shadows.rendering.exact_shadow import exact_visibility
from neural_shadows.rendering.gbuffer import render_gbuffer
from neural_shadows.scenes.cameras import VIEW_SETS, Viewpoint, camera_axes
from neural_shadows.scenes.lights import draw_light, light_basis
from neural_shadows.scenes.scene import Scene

FOV = 45.0
# A candidate is judged by a picture of this many rows; the first good one is taken, else the best.
_PROBE_ROWS = 24
_CANDIDATES = 48


def draw_viewpoints(
    scene: Scene,
    view_sets: Iterable[str],
    indices: Iterable[int],
    aspect: float,
    seed: int,
    least_shadow: float = 0.0,
) -> list[Viewpoint]:
    """Draw viewpoints `indices` of each of `view_sets`, in order [4.1].

    A viewpoint depends on the scene, the aspect ratio, `seed`, its set and its number alone:
    sets can be drawn in batches, and more viewpoints leave the earlier ones as they were. Each
    draws its own light.

    `shadow`: at the shadow cast on the scene's ground, which fills about two fifths of the frame, from
    where the object hides little of it.
    `surface`: at a visible point of the object's surface that is turned to the light.
    `centre`: at the centre of the bounding sphere, from 20 to 70 degrees above.

    Args:
        aspect: width / height of the frames to come.
        least_shadow: share of a viewpoint's surface that must lie in cast shadow; light and
            camera are drawn until it does, and or else the best of `_CANDIDATES`.

    Raises:
        InputError: `surface` for a scene without lit surface.
    """
    indices = tuple(indices)
    draw = {"shadow": _draw_shadow, "surface": _draw_surface, "centre": _draw_centre}
    (light_domain,) = scene.lights
    viewpoints = []
    for view_set in view_sets:
        for index in indices:
            key = (list(VIEW_SETS).index(view_set), index)
            rng = np.random.default_rng(np.random.SeedSequence(seed, spawn_key=key))
            most = -np.inf
            for _ in range(_CANDIDATES):
                light = draw_light(light_domain, scene.up, rng)
                eye, target = draw[view_set](scene, aspect, light, rng)
                view = Viewpoint(view_set, index, eye, target, scene.up, FOV, light)
                share = _cast_shadow(scene, aspect, view) if least_shadow else 0.0
                if share > most:
                    most, chosen = share, view
                if share >= least_shadow:
                    break
            viewpoints.append(chosen)
    return viewpoints


def surface_points(
    scene: Scene, count: int, rng: np.random.Generator
) -> tuple[np.ndarray, np.ndarray]:
    """Uniform points on the object's surface, and normals: (count, 3) each."""
    (mesh,) = scene.objects
    areas = rng.uniform(0, scene.cumulative_area[-1], count)
    face = np.searchsorted(scene.cumulative_area, areas)
    face = np.minimum(face, len(scene.cumulative_area) - 1)
    a, b, c = (mesh.vertices[mesh.faces[face, k]].astype(np.float64) for k in range(3))
    # The square root spreads points evenly over a triangle (Turk 1990).
    s, t = np.sqrt(rng.uniform(size=(count, 1))), rng.uniform(size=(count, 1))
    return (1 - s) * a + s * (1 - t) * b + s * t * c, mesh.face_normals[face]


def _direction_above(up: np.ndarray, lowest: float, highest: float, rng: np.random.Generator):
    """Uniform unit vector (3,) between two elevations in degrees."""
    sine = rng.uniform(np.sin(np.radians(lowest)), np.sin(np.radians(highest)))
    azimuth = rng.uniform(0, 2 * np.pi)
    cosine = np.sqrt(1 - sine**2)
    return np.array([cosine * np.cos(azimuth), cosine * np.sin(azimuth), sine]) @ light_basis(up)


def _cast_shadow(scene: Scene, aspect: float, view: Viewpoint) -> float:
    """Share of a view's surface in cast shadow."""
    frame = render_gbuffer(scene, view, round(_PROBE_ROWS * aspect), _PROBE_ROWS)
    lit = np.count_nonzero(exact_visibility(scene.tracer, frame))
    return (len(frame.lit_side) - lit) / max(1, len(frame.pixel))


def _shares(scene: Scene, aspect: float, eye: np.ndarray, target: np.ndarray, light: np.ndarray):
    """Shares of a frame's pixels of cast shadow on the ground and object."""
    view = Viewpoint("", 0, eye, target, scene.up, FOV, light)
    frame = render_gbuffer(scene, view, round(_PROBE_ROWS * aspect), _PROBE_ROWS)
    dark = exact_visibility(scene.tracer, frame) == 0
    pixels = frame.width * frame.height
    return np.count_nonzero(dark & ~frame.is_object) / pixels, frame.is_object.sum() / pixels


def _draw_shadow(scene: Scene, aspect: float, light: np.ndarray, rng: np.random.Generator):
    points, _ = surface_points(scene, 256, rng)
    drop = (points @ scene.up - scene.ground) / (light @ scene.up)
    shadow = points - drop[:, None] * light
    best = -np.inf
    for _ in range(_CANDIDATES):
        direction = _direction_above(scene.up, 20, 75, rng)
        # Between the middle of the shadow and any point of it: varied, yet seldom its rim.
        middle, other = shadow.mean(0), shadow[rng.integers(len(shadow))]
        target = middle + rng.uniform() * (other - middle)
        right, upward, _ = camera_axes(target + direction, target, scene.up)
        extent = np.abs((shadow - target) @ np.stack([right, upward], axis=1))
        across, along = np.quantile(extent, 0.9, axis=0)
        fitting = max(across / aspect, along) / np.tan(np.radians(FOV / 2))
        eye = target + rng.uniform(0.5, 1.2) * fitting * direction
        cast, occluder = _shares(scene, aspect, eye, target, light)
        # Ideal: half the frame in shadow, which has the most outline, and no object in it.
        fitness = -abs(cast - 0.5) - 1.5 * occluder
        if fitness > best:
            best, chosen = fitness, (eye, target)
        if fitness > -0.2:
            break
    return chosen


def _draw_surface(scene: Scene, aspect: float, light: np.ndarray, rng: np.random.Generator):
    best = -np.inf
    for _ in range(_CANDIDATES):
        eye, target = _see_surface(scene, light, rng)
        _, share = _shares(scene, aspect, eye, target, light)
        if share > best:
            best, chosen = share, (eye, target)
        if share >= 0.4:
            break
    return chosen


def _see_surface(scene: Scene, light: np.ndarray, rng: np.random.Generator):
    """Draw an eye outside the bounding sphere and a visible target."""
    for _ in range(1000):  # on the dragon one in six will do
        points, normals = surface_points(scene, 1, rng)
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
        "view_sets: surface: no point of the object is both lit and seen from above. "
        "Check the mesh, the scene's up and its light."
    )


def _draw_centre(scene: Scene, aspect: float, light: np.ndarray, rng: np.random.Generator):
    direction = _direction_above(scene.up, 20, 70, rng)
    return rng.uniform(1.1, 1.8) * direction, np.zeros(3)
