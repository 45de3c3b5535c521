"""Four rays a pixel of a soft shadow, to Embree by packages and from C; all on one thread.

A room with an object, 512 × 256, in the order in which `ray_traced` sends them. The pipeline's
own rays are packets of eight, compiled by numba (`embree_packets.py`). embreex sends single rays, and
so does Open3D; Mitsuba sends packets as wide as the processor's vectors. From C it is embreex's own
library, with and without the flag ROBUST that embreex sets: without it a ray may slip between two
triangles. On an AMD EPYC with AVX-512, loaded: 5.8 M rays/s by embreex and as many singly from C with
ROBUST, packets of 8 and 16 then 1.6 and 1.9 times as many, without it 2.0 and 2.4, the pipeline 1.6,
Open3D 0.91, Mitsuba 2.5.
Processor time of the whole process, from arrays in memory to a bool for each ray; what a package must
have done to the arrays first is in its time, and in a row of its own is not.
"""

from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

import numpy as np
from embree_rays import SINGLE, EmbreeTriangles, check_compiled
from measurement import Row, median_seconds

from neural_shadows.frames.draw_settings import FrameKind, draw_setting, light_map_of
from neural_shadows.frames.soft_frame import SoftFrame
from neural_shadows.frames.soft_scene import SoftScene
from neural_shadows.meshes.prepared_mesh import PreparedMesh
from neural_shadows.rendering.light_samples import ring_vectors
from neural_shadows.rendering.surface import see_surface
from neural_shadows.scenes.tracing import NEARLY_ALL, EmbreeSingly

SCENE = {"generate": "room", "seed": 2026, "inserted": {"mesh": "y"}}
KIND = FrameKind(
    512, 256, 55, None, {"kind": "perspective", "fov": 120, "resolution": 512}, radius=0.25
)
RADIUS, SAMPLES = 0.125, 4  # metres, rays a pixel
EMBREEX, OWN, BEFORE = "embreex", "packets, as the pipeline sends them", "arrays converted before"

Works = dict[str, Callable[[], np.ndarray]]


def rows(mesh_ply: Path, quick: bool) -> list[Row]:
    """Rays a second of each, beside embreex, and how many of its answers differ."""
    check_compiled()
    scene = SoftScene(SCENE, [mesh_ply])
    points, ways = _rays(scene)
    mesh, rays = scene.at_rest.joined, (points, ways, NEARLY_ALL)
    works: Works = {
        EMBREEX: partial(EmbreeSingly(mesh.vertices, mesh.faces).occluded, *rays),
        OWN: partial(scene.at_rest.tracer.blocked, points, ways),
    }
    notes = {"": False, ", robust": True}
    embrees = [
        EmbreeTriangles(mesh.vertices, mesh.faces, robust=robust) for robust in notes.values()
    ]
    for embree, note in zip(embrees, notes):
        forms = {SINGLE: partial(embree.single, *rays), **embree.packet_forms(*rays)}
        works |= {name + note: work for name, work in forms.items()}
    for package, others in (("open3d", _by_open3d), ("mitsuba", _by_mitsuba)):
        try:
            works |= dict(others(mesh, points, ways))
        except ImportError as error:
            print(f"{package} is left out ({error}): pip install -r envs/benchmarks.txt")
    exact = works[EMBREEX]()
    differ = {name: np.count_nonzero(work() != exact) for name, work in works.items()}
    seconds = median_seconds(works, 5 if quick else 15, "process_time")
    for embree in embrees:
        embree.close()
    rate = {name: len(points) / value for name, value in seconds.items()}
    stage = f"{len(points):,} rays, {len(mesh.faces):,} triangles"
    return [
        Row(
            f"{stage}: {name}, {differ[name]} answers differ",
            "cpu x1",
            value,
            "rays/s",
            peer=EMBREEX,
            peer_rate=rate[EMBREEX],
        )
        for name, value in rate.items()
    ]


def _rays(scene: SoftScene) -> tuple[np.ndarray, np.ndarray]:
    """Points and ways to the light, (rays, 3) float32 each."""
    setting = draw_setting(scene, KIND, np.random.default_rng(2))
    surface = see_surface(scene.at_rest, setting.camera, KIND.width, KIND.height)
    light_map = light_map_of(KIND.light_map, scene, setting.centre)
    frame = SoftFrame(scene.at_rest, surface, setting.centre, light_map)
    ways = np.empty((len(frame.starts), SAMPLES, 3), np.float32)
    light = frame.centre, np.array([RADIUS]), np.array([SAMPLES])
    ring_vectors(frame.starts, surface.pixel, 0, *light, ways)
    return np.repeat(frame.starts, SAMPLES, axis=0), ways.reshape(-1, 3)


def _by_open3d(mesh: PreparedMesh, points, ways) -> Iterator[tuple[str, Callable]]:
    import open3d as o3d

    scene = o3d.t.geometry.RaycastingScene(nthreads=1)
    faces = mesh.faces.astype(np.uint32)
    scene.add_triangles(o3d.core.Tensor(mesh.vertices), o3d.core.Tensor(faces))
    told = {"tfar": NEARLY_ALL, "nthreads": 1}

    def joined() -> o3d.core.Tensor:
        return o3d.core.Tensor.from_numpy(np.concatenate([points, ways], axis=1))

    rays = joined()
    yield "Open3D", lambda: scene.test_occlusions(joined(), **told).numpy()
    yield f"Open3D, {BEFORE}", lambda: scene.test_occlusions(rays, **told).numpy()


def _by_mitsuba(mesh: PreparedMesh, points, ways) -> Iterator[tuple[str, Callable]]:
    import drjit
    import mitsuba as mi

    mi.set_variant("llvm_ad_rgb")
    drjit.set_thread_count(1)
    triangles = mi.Mesh("mesh", len(mesh.vertices), len(mesh.faces))
    parameters = mi.traverse(triangles)
    parameters["vertex_positions"] = mesh.vertices.ravel()
    parameters["faces"] = mesh.faces.astype(np.uint32).ravel()
    parameters.update()
    scene = mi.load_dict({"type": "scene", "mesh": triangles})

    def turned() -> tuple:
        arrays = (mi.Point3f(points.T), mi.Vector3f(ways.T))
        drjit.eval(arrays)
        return arrays

    def blocked(origins, directions) -> np.ndarray:
        ray = mi.Ray3f(origins, directions, NEARLY_ALL, 0.0, mi.Color0f())
        return scene.ray_test(ray).numpy()

    rays = turned()
    yield "Mitsuba, llvm", lambda: blocked(*turned())
    yield f"Mitsuba, llvm, {BEFORE}", lambda: blocked(*rays)
