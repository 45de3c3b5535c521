"""Stage: hours of sun and view of the sky on a mesh, by its field and by Embree."""

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

import numpy as np
from threadpoolctl import threadpool_limits

from neural_shadows.files.whole_files import whole_file, write_json
from neural_shadows.meshes.prepared_mesh import PreparedMesh, read_prepared
from neural_shadows.meshes.uniform_points import uniform_points
from neural_shadows.rendering.gbuffer import pixel_directions
from neural_shadows.representations.shadow_field.shadow_field import ShadowField
from neural_shadows.running.origin import describe_origin
from neural_shadows.running.stage import run_stage
from neural_shadows.scenes.cameras import Camera, camera_axes
from neural_shadows.scenes.sky import scene_axes, sky_patches, sun_directions
from neural_shadows.scenes.tracing import Tracer

# Starts of rays off the surface: of the field in cells, of triangles in radii. Of a city at 512³ a sixth
# of a cell makes 3.5 % of the sky's rays false shadows, at edges, a third 1.4 %, a half 1.2 %; leaks grow
# from 0.8 to 1.4 %.
CELLS, RADII = 1 / 3, 1e-4
FOV, ELEVATION, AZIMUTH = 24.0, 36.0, 205.0  # of the picture's camera, degrees; azimuth from north
ASPECT = 1.6


class Rays(NamedTuple):
    """Directions of a day's sun and of the sky's patches."""

    directions: np.ndarray  # (d, 3) unit vectors
    hours: np.ndarray  # (d,) of sun, 0 of a patch
    shares: (
        np.ndarray
    )  # (d,) of a uniform sky's light on level ground over the height, 0 of the sun


@dataclass
class Daylight:
    """Hours of sun and view of the sky by one method, with its time."""

    occluded: Callable[[np.ndarray, np.ndarray], np.ndarray]  # of points (n, 3) and a direction
    points: np.ndarray  # (n, 3)
    seconds: float = 0.0
    rays: int = 0
    hours: np.ndarray = field(init=False)  # (n,)
    sky: np.ndarray = field(init=False)  # (n,) 1 is level ground below a whole sky

    def __post_init__(self) -> None:
        self.hours, self.sky = np.zeros((2, len(self.points)))

    def add(self, facing: np.ndarray, cosines: np.ndarray, rays: Rays, number: int) -> np.ndarray:
        """Add a direction for facing points; return their occlusion."""
        points, direction = self.points[facing], rays.directions[number]
        started = time.process_time()
        occlusion = self.occluded(points, direction)
        self.seconds += time.process_time() - started
        self.rays += len(facing)
        self.hours[facing] += rays.hours[number] * ~occlusion
        self.sky[facing] += rays.shares[number] * cosines * ~occlusion
        return occlusion


# The waiting of BLAS's other threads would count as a method's time.
@threadpool_limits.wrap(limits=1)
def measure_sun_hours(
    mesh_ply: Path,
    hours_npz: Path,
    hours_json: Path,
    *,
    up: str,
    resolution: int,
    points: int,
    width: int,
    latitude: float,
    day: int,
    minutes: float,
    seed: int,
) -> None:
    """Measure hours of sun and view of the sky by field and Embree, on one thread.

    Args:
        hours_npz: `hours` and `sky` of a picture from above aslant, (H, W) float32, by the field; NaN
            where it shows nothing.
        hours_json: `fields` and `embree` with `build_seconds`, `seconds` and `rays`, the share of
            rays `unlike`, and the mean of `hours` and `sky` with those of their differences.
        up: vertical axis. resolution: of the field.
        points: on the surface, spread evenly; those with the same rays by both.
        width: of the picture, pixels.
        latitude, day, minutes: see `sun_directions`.

    Raises:
        InputError: the mesh cannot be read, or a value is out of range.
    """
    mesh, rays = read_prepared(mesh_ply), _rays(up, latitude, day, minutes)
    _compile()
    started = time.process_time()
    shadow_field = ShadowField.fit((mesh.vertices, mesh.faces), resolution)
    fitted = time.process_time()
    tracer = Tracer(mesh.vertices, mesh.faces)
    built = time.process_time()
    places, face = uniform_points(mesh.vertices, mesh.faces, points, np.random.default_rng(seed))
    # In the order of faces, as models have them: Embree's packets of eight then stay together.
    order = np.argsort(face)
    places, normals = np.float32(places[order]), mesh.face_normals[face[order]]
    by_field = Daylight(shadow_field.occluded, places + CELLS * shadow_field.cell * normals)
    by_embree = Daylight(_by(tracer), places + np.float32(RADII) * normals)
    for method in (by_field, by_embree):  # compiles, too
        method.occluded(method.points, rays.directions[0])
    unlike = _add_all([by_field, by_embree], normals, rays)
    record = {
        "faces": len(mesh.faces),
        "sheet": shadow_field.sheet,
        "resolution": resolution,
        "points": points,
        "field": _times(by_field, fitted - started) | {"bytes": shadow_field.bytes},
        "embree": _times(by_embree, built - fitted),
        "unlike": unlike / max(by_field.rays, 1),
        "sun_directions": int((rays.hours > 0).sum()),
        "latitude": latitude,
        "day": day,
        **_differences(by_field, by_embree, "hours"),
        **_differences(by_field, by_embree, "sky"),
    }
    picture = _picture(mesh, tracer, shadow_field, up, width, rays)
    with whole_file(hours_npz) as part, part.open("wb") as file:
        np.savez_compressed(file, **picture)
        write_json(hours_json, record | describe_origin())


def _compile() -> None:
    """Compile the loops of fits, of a solid and of a sheet, or read what is compiled."""
    corners = np.concatenate([np.zeros((1, 3)), np.eye(3)])
    faces = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    for part in (faces, faces[:1]):
        ShadowField.fit((corners, part), 8)


def _rays(up: str, latitude: float, day: int, minutes: float) -> Rays:
    suns = sun_directions(latitude, day, minutes, up)
    patches, angles = sky_patches(up)
    shares = angles / (angles @ (patches @ scene_axes(up)[2]))
    none = np.zeros(len(patches))
    return Rays(
        np.concatenate([suns, patches]),
        np.concatenate([np.full(len(suns), minutes / 60), none]),
        np.concatenate([np.zeros(len(suns)), shares]),
    )


def _by(tracer: Tracer) -> Callable[[np.ndarray, np.ndarray], np.ndarray]:
    """Embree's occlusion of points in a direction."""
    directions = np.empty((0, 3), np.float32)

    def occluded(points: np.ndarray, direction: np.ndarray) -> np.ndarray:
        nonlocal directions
        if len(directions) < len(points):
            directions = np.empty((len(points), 3), np.float32)
        directions[: len(points)] = direction
        return tracer.occluded(points, directions[: len(points)])

    return occluded


def _add_all(methods: list[Daylight], normals: np.ndarray, rays: Rays) -> int:
    """Add all directions by each method in turn; return the number of unlike rays."""
    unlike = 0
    for number, direction in enumerate(rays.directions.astype(np.float32)):
        cosines = normals @ direction
        facing = np.flatnonzero(cosines > 0)
        occlusions = [method.add(facing, cosines[facing], rays, number) for method in methods]
        unlike += int((occlusions[0] != occlusions[-1]).sum())
    return unlike


def _times(method: Daylight, build: float) -> dict[str, float]:
    return {"build_seconds": build, "seconds": method.seconds, "rays": method.rays}


def _differences(a: Daylight, b: Daylight, name: str) -> dict[str, float]:
    of_a, of_b = getattr(a, name), getattr(b, name)
    return {name: float(of_b.mean()), f"{name}_difference": float(np.abs(of_a - of_b).mean())}


def _picture(
    mesh: PreparedMesh, tracer: Tracer, shadow_field: ShadowField, up: str, width: int, rays: Rays
) -> dict[str, np.ndarray]:
    """`hours` and `sky` of the pixels of a picture of the mesh."""
    camera, height = _camera(mesh, up), int(width / ASPECT)
    directions = pixel_directions(camera, width, height)
    eye = np.tile(camera.eye.astype(np.float32), (len(directions), 1))
    t, face = tracer.first_hit(eye, directions)
    pixel = np.flatnonzero(face >= 0)
    towards = directions[pixel]
    normals = mesh.face_normals[face[pixel]]
    normals *= -np.sign(np.einsum("ij,ij->i", normals, towards))[:, None]
    places = eye[pixel] + t[pixel, None] * towards + CELLS * shadow_field.cell * normals
    daylight = Daylight(shadow_field.occluded, places)
    _add_all([daylight], normals, rays)
    picture = np.full((2, height * width), np.nan, np.float32)
    picture[:, pixel] = daylight.hours, daylight.sky
    return dict(zip(("hours", "sky"), picture.reshape(2, height, width)))


def _camera(mesh: PreparedMesh, axis: str) -> Camera:
    """A camera from above aslant that just holds the mesh, from the sunny side."""
    east, north, up = scene_axes(axis)
    azimuth, elevation = np.radians(AZIMUTH), np.radians(ELEVATION)
    level = np.sin(azimuth) * east + np.cos(azimuth) * north
    away = np.cos(elevation) * level + np.sin(elevation) * up
    axes = camera_axes(away, np.zeros(3), up)
    seen = mesh.vertices.astype(np.float64) @ axes.T  # right, up, forward
    target = np.array([*(seen[:, :2].min(0) + seen[:, :2].max(0)) / 2, 0.0])
    half = np.tan(np.radians(FOV) / 2)
    reach = np.abs(seen[:, :2] - target[:2]) / [half * ASPECT, half]
    distance = 1.02 * (reach.max(axis=1) - seen[:, 2]).max()
    middle = target @ axes
    return Camera(middle + distance * away, middle, up, FOV)


if "snakemake" in globals():
    run_stage(snakemake, measure_sun_hours)
