"""A field's shadow rays beside Embree's packets of eight from C.

From points and a light to answers, the same points for all, one thread, interleaved rounds, times of
the thread; a light's tables are built anew for each answer. Beside the mesh itself; the smallest
decimated one that is no more unlike it than the field; the same surface with detail in millions of
triangles; a lamp; and an open sheet. And how long a field of millions of triangles takes to fit.
"""

import resource
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import islice
from pathlib import Path

import numpy as np
from detailed_mesh import detailed_meshes
from embree_rays import PACKETS, EmbreeTriangles
from measurement import Row, median_seconds

from neural_shadows import ShadowField
from neural_shadows.meshes.prepared_mesh import PreparedMesh
from neural_shadows.rendering.gbuffer import render_gbuffer
from neural_shadows.rendering.viewpoints import draw_viewpoints
from neural_shadows.representations.distance_bricks import field_occlusion
from neural_shadows.representations.distance_bricks.compiled_occlusion import compiled_occlusion
from neural_shadows.representations.distance_bricks.field_bricks import FieldBricks
from neural_shadows.representations.distance_bricks.light_tables import (
    directional_tables,
    merging,
    most_bytes,
    point_tables,
)
from neural_shadows.representations.meshes.decimation import decimated
from neural_shadows.scenes.lights import axis_vector
from neural_shadows.scenes.scene import Scene, make_scene, open_scene

SCENE = {"up": "y", "ground": True, "light": {"domain": "sphere", "min_elevation_deg": 20}}
WIDTH, HEIGHT, SEED = 1200, 800, 2026
VIEW_SETS, VIEWS = ("shadow", "surface", "centre"), range(3)
IN_C, IN_NUMBA, TABLES = "field in C", "field in Numba", "a light's tables alone"
RESOLUTION = 256
# With detail: triangles, and fields, of which the finer one holds most of it.
MOST, RESOLUTIONS = 13_000_000, (256, 512)
FEWER = (5_000, 10_000, 20_000, 30_000, 40_000, 60_000, 80_000, 120_000)  # triangles
LAMP = np.array([1.2, 1.5, 0.9])  # in radii
HILLS = 350  # vertices along a side of the sheet

Query = Callable[[], np.ndarray]


@dataclass(frozen=True, eq=False)
class Rays:
    """Points of a frame and their light."""

    points: np.ndarray  # (n, 3) float32
    light: np.ndarray  # (3,) float32, a direction, or a position
    lamp: bool = False

    def tables(self, bricks: FieldBricks) -> list:
        """The light's tables."""
        if self.lamp:
            return point_tables(bricks, self.light, merging(len(self.points) // 4, bricks))
        return [directional_tables(bricks, self.light, merging(len(self.points), bricks))]

    def marked(self, mark: Callable[..., None], bricks: FieldBricks) -> np.ndarray:
        """Occlusion by a field, (n,) bool, tables and all."""
        occlusion = np.zeros(len(self.points), bool)
        for light in self.tables(bricks):
            mark(self.points, light, bricks, np.float32(0), occlusion)
        return occlusion

    @cached_property
    def to_light(self) -> np.ndarray:
        """One direction, or of each point that to the lamp."""
        return np.float32(self.light) - self.points if self.lamp else self.light

    def through(self, triangles: EmbreeTriangles, coherent: bool = True) -> np.ndarray:
        """Occlusion by triangles, (n,) bool."""
        end = 1.0 if self.lamp else np.inf
        return triangles.occluded(self.points, self.to_light, end, coherent=coherent)


def rows(mesh_ply: Path, quick: bool) -> list[Row]:
    """Rates, wrong answers and memory of a mesh's field; fits of ever more triangles."""
    scene, rounds = open_scene(mesh_ply, **SCENE), 3 if quick else 5
    (mesh,) = scene.objects
    _, bricks = _fitted(mesh.vertices, mesh.faces)
    triangles, frames = EmbreeTriangles(mesh.vertices, mesh.faces), _frames(scene)
    name = f"{len(mesh.faces):,} triangles"
    result = _rate_rows(name, bricks, triangles, frames, rounds, by_frame=True)
    result += _equal_error_rows(bricks, triangles, frames, rounds)
    lamps = [Rays(frame.points, LAMP, lamp=True) for frame in frames]
    result += _rate_rows(f"{name}, a lamp", bricks, triangles, lamps, rounds)
    triangles.close()
    result += _detail_rows(mesh, 2 if quick else None, rounds)
    return result + _sheet_rows(rounds)


def _fitted(
    vertices: np.ndarray, faces: np.ndarray, resolution: int = RESOLUTION
) -> tuple[np.ndarray, FieldBricks]:
    """A mesh's vertices in its unit sphere, and the bricks of its field."""
    field = ShadowField.fit((vertices, faces), resolution)
    return np.float32((vertices - field.centre) / field.radius), field._field_bricks


def _frames(scene: Scene) -> list[Rays]:
    """The points of nine frames that face the light and are behind or in the sphere."""
    frames = []
    for view in draw_viewpoints(scene, VIEW_SETS, VIEWS, WIDTH / HEIGHT, SEED):
        frame, light = render_gbuffer(scene, view, WIDTH, HEIGHT), np.float32(view.light)
        along = frame.p @ light
        across = np.square(frame.p - along[:, None] * light).sum(axis=1)
        passes = (across < 1) & (along < np.sqrt(np.maximum(1 - across, 0)))
        frames.append(Rays(np.ascontiguousarray(frame.p[passes]), light))
    return frames


def _rate_rows(
    name: str,
    bricks: FieldBricks,
    triangles: EmbreeTriangles,
    frames: list[Rays],
    rounds: int,
    by_frame: bool = False,
) -> list[Row]:
    """Rates in each frame, their ratios to packets', and unlike answers."""
    result, ratios, unlike = [], {}, np.zeros(3)
    in_c = compiled_occlusion()
    marks = {IN_NUMBA: field_occlusion.mark_occluded} | ({IN_C: in_c} if in_c else {})
    for number, frame in enumerate(frames):
        works: dict[str, Query] = {
            PACKETS: lambda frame=frame: frame.through(triangles),
            "not coherent": lambda frame=frame: frame.through(triangles, coherent=False),
            TABLES: lambda frame=frame: frame.tables(bricks),
        }
        for form, mark in marks.items():
            works[form] = lambda frame=frame, mark=mark: frame.marked(mark, bricks)
        seconds = median_seconds(works, rounds, "thread_time")
        seconds[PACKETS] = min(seconds[PACKETS], seconds.pop("not coherent"))
        rate = {form: len(frame.points) / value for form, value in seconds.items()}
        rays = f"{name}, frame {number}, {len(frame.points):,} rays"
        for form, value in rate.items():
            ratios.setdefault(form, []).append(value / rate[PACKETS])
            if by_frame:
                result.append(
                    Row(f"{rays}: {form}", "cpu x1", value, "rays/s", None, PACKETS, rate[PACKETS])
                )
        unlike += _unlike(bricks, triangles, frame)
    for form in marks:
        for part, of_frames in ((np.median, "median"), (np.min, "least")):
            stage = f"{name}: {form} over {PACKETS}, {of_frames} of {len(frames)} frames"
            result.append(Row(stage, "cpu x1", float(part(ratios[form])), "×"))
    for kind, count in zip(("false shadow", "leak", "C unlike Numba"), unlike):
        result.append(Row(f"{name}: {kind}", "cpu", 100 * count / _count(frames), "% of rays"))
    own, peer = (bricks.bytes + most_bytes(bricks)) / 1024, triangles.bytes / 1024
    held = f"Embree's tree and {len(triangles.faces):,} triangles"
    return [*result, Row(f"{name}: held", "cpu", own, "KiB", None, held, peer)]


def _count(frames: list[Rays]) -> int:
    return sum(len(frame.points) for frame in frames)


def _unlike(bricks: FieldBricks, triangles: EmbreeTriangles, frame: Rays) -> np.ndarray:
    """Numbers of rays: false shadow, leak, and answers in C unlike Numba's."""
    exact, numbas = frame.through(triangles), frame.marked(field_occlusion.mark_occluded, bricks)
    in_c = compiled_occlusion()
    differ = (frame.marked(in_c, bricks) != numbas).sum() if in_c else 0
    return np.array([(numbas & ~exact).sum(), (~numbas & exact).sum(), differ])


def _equal_error_rows(
    bricks: FieldBricks, exact: EmbreeTriangles, frames: list[Rays], rounds: int
) -> list[Row]:
    """Rates beside the smallest decimated mesh that is no more unlike the whole than the field."""
    own = sum(_unlike(bricks, exact, frame)[:2].sum() for frame in frames)
    for wanted in FEWER:
        fewer = EmbreeTriangles(*decimated(exact.vertices, exact.faces, wanted))
        unlike = sum((frame.through(fewer) != frame.through(exact)).sum() for frame in frames)
        if unlike <= own or wanted == FEWER[-1]:
            break
        fewer.close()
    shares = [100 * count / _count(frames) for count in (unlike, own)]
    name = f"{len(fewer.faces):,} triangles ({shares[0]:.3f} % unlike the whole, field {shares[1]:.3f})"
    return _rate_rows(name, bricks, fewer, frames, rounds)


def _detail_rows(mesh: PreparedMesh, most: int | None, rounds: int) -> list[Row]:
    """A surface with detail in ever more triangles, each with its own fits."""
    arrays, result = (mesh.vertices, mesh.faces, mesh.vertex_normals), []
    meshes: Iterator = detailed_meshes(*arrays, 2 / RESOLUTION, MOST)
    for given, faces in islice(meshes, most):
        frames, triangles = [], None
        for resolution in RESOLUTIONS:
            name = f"{len(faces):,} triangles with detail, {resolution}³"
            started = time.process_time()
            vertices, bricks = _fitted(given, faces, resolution)
            seconds = time.process_time() - started
            result.append(Row(f"{name}: fit, of processors", "cpu", seconds, "s"))
            peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20
            result.append(Row(f"{name}: largest memory until then", "cpu", peak, "GiB"))
            if triangles is None:
                frames = _frames(_scene_of(vertices, faces))
                triangles = EmbreeTriangles(vertices, faces)
            result += _rate_rows(name, bricks, triangles, frames, rounds)
        triangles.close()
    return result


def _scene_of(vertices: np.ndarray, faces: np.ndarray) -> Scene:
    """A scene that is not shaded."""
    mesh = PreparedMesh(vertices, faces, np.zeros_like(vertices), _normals(vertices, faces))
    up = axis_vector(SCENE["up"])
    return make_scene(mesh, up=up, ground=SCENE["ground"], light=SCENE["light"])


def _normals(vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    return normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), np.float32(1e-30))


def _sheet_rows(rounds: int) -> list[Row]:
    """An open sheet with points just above it, of low and high suns."""
    vertices, faces = _hills()
    vertices, bricks = _fitted(vertices, faces)
    assert bricks.sheet
    normals = _normals(vertices, faces)
    points = vertices[faces].mean(axis=1) + np.float32(0.3 * 2 / RESOLUTION) * normals
    suns = np.array([[1, 0.15, 0.3], [0.3, 0.4, -1], [0.2, 1, 0.1]])
    suns /= np.linalg.norm(suns, axis=1, keepdims=True)
    frames = [Rays(np.float32(points), np.float32(sun)) for sun in suns]
    triangles = EmbreeTriangles(vertices, faces)
    name = f"{len(faces):,} triangles, an open sheet"
    return _rate_rows(name, bricks, triangles, frames, rounds)


def _hills() -> tuple[np.ndarray, np.ndarray]:
    """Vertices (V, 3) and faces (F, 3), upwards, of a height field, row by row."""
    side = np.linspace(-0.6, 0.6, HILLS)
    x, z = np.meshgrid(side, side, indexing="ij")
    y = 0.1 * np.sin(9 * x) * np.cos(7 * z) + 0.02 * np.sin(50 * x + 3) * np.sin(43 * z)
    corner = np.arange(HILLS**2).reshape(HILLS, HILLS)
    a, b, c, d = corner[:-1, :-1], corner[1:, :-1], corner[1:, 1:], corner[:-1, 1:]
    faces = np.stack([a, d, b, b, d, c], axis=-1).reshape(-1, 3)
    return np.stack([x, y, z], axis=-1).reshape(-1, 3), faces
