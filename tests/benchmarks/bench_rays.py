"""Rays against triangles: packets beside embreex's single rays, and the stage of ray sets.

The ceiling of the stage is Embree alone, in as many threads, on the same first and second hits and
the silhouettes' occlusion rays with them; its peer, of the hits alone, is trimesh.
"""

import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import trimesh
from measurement import Row, median_seconds

from neural_shadows.frames.draw_settings import FrameKind, draw_setting
from neural_shadows.frames.soft_scene import SoftScene
from neural_shadows.meshes.prepared_mesh import read_prepared
from neural_shadows.rays.draw_directions import draw_directions
from neural_shadows.rays.labels import SECOND_HIT_STEP
from neural_shadows.rays.ray_set import RaySet
from neural_shadows.rays.sample_rays import sample_rays
from neural_shadows.rays.silhouette import silhouette
from neural_shadows.rendering.light_samples import random_shifts, ring_vectors, sequence_run
from neural_shadows.rendering.surface import see_surface
from neural_shadows.scenes.embree_packets import EmbreePackets
from neural_shadows.scenes.tracing import NEARLY_ALL, EmbreeSingly, Tracer

SCENE = {"generate": "room", "seed": 2026, "inserted": {}}
RADII = (0.0625, 0.25, 1.0)  # of the lights, metres
SAMPLES = (1, 4, 16)  # rays of a pixel
DIFFERING = 1e-6  # share of rays on which the two may differ: one of 8.3 million did
PACKETS, SINGLE = "packets", "embreex's single rays"

SAMPLING = {
    "sampler": "poisson_quadtree",
    "points_per_direction": 10_000,  # as in the thesis [4.1]
    "silhouette_resolution": 128,
    "min_quad": 1,
}
THREADS = 2
PEER_RAYS = 100_000


def packet_rows(quick: bool) -> list[Row]:
    """Rays a second of one frame of a room, on one thread; both give the same but for `DIFFERING`, or it stops.

    Shadow rays to lights of three sizes and to a parallel one, first hits of the camera's rays, and
    rays that have nothing in common.
    """
    scene = SoftScene(SCENE, [])
    kind = FrameKind(512, 256, 55, None, {"kind": "perspective", "fov": 120, "resolution": 512}, 1)
    setting = draw_setting(scene, kind, np.random.default_rng(2))
    mesh, rest = scene.at_rest.joined, scene.at_rest
    surface = see_surface(rest, setting.camera, kind.width, kind.height)
    starts = surface.p + np.float32(1e-4 * rest.size) * surface.n_g
    packets, singly = (form(mesh.vertices, mesh.faces) for form in (EmbreePackets, EmbreeSingly))
    rounds, result = 2 if quick else 5, []

    def add(stage: str, query: str, points: np.ndarray, to_light: np.ndarray, *end: float) -> None:
        works = {
            name: lambda rays=rays: getattr(rays, query)(points, to_light, *end)
            for name, rays in ((PACKETS, packets), (SINGLE, singly))
        }
        for ours, theirs in zip(*(np.atleast_2d(work()) for work in works.values())):
            assert np.count_nonzero(ours != theirs) <= DIFFERING * len(points)
        rate = {name: len(points) / value for name, value in median_seconds(works, rounds).items()}
        result.append(Row(stage, "cpu x1", rate[PACKETS], "rays/s", None, SINGLE, rate[SINGLE]))

    for radius in RADII:
        for samples in SAMPLES:
            to_light = np.empty((len(starts), samples, 3), np.float32)
            light = setting.centre, np.array([radius]), np.array([samples])
            ring_vectors(
                starts, random_shifts(surface.pixel, 1), sequence_run(0, samples), *light, to_light
            )
            points = np.repeat(starts, samples, axis=0)
            stage = f"shadow rays, light of {radius} m, {samples} a pixel"
            add(stage, "occluded", points, to_light.reshape(-1, 3), NEARLY_ALL)
    sun = np.tile(np.float32([[1, 3, 2]]), (len(starts), 1))
    add("shadow rays, parallel", "occluded", starts, sun)
    eye = np.broadcast_to(setting.camera.eye.astype(np.float32), starts.shape).copy()
    add("first hits of the camera's rays", "first_hit", eye, surface.p - eye)
    mixed = starts[np.random.default_rng(0).permutation(len(starts))]
    add("rays from any point to any other", "occluded", starts, mixed - starts, NEARLY_ALL)
    return result


def label_rows(mesh_ply: Path, quick: bool) -> list[Row]:
    """Samples a second of the stage that samples and labels rays."""
    with tempfile.TemporaryDirectory() as folder:
        return _label_rows(mesh_ply, Path(folder), 100 if quick else 500, 3)


def _label_rows(mesh_ply: Path, folder: Path, count: int, rounds: int) -> list[Row]:
    files = {
        "mesh_ply": mesh_ply,
        "directions_npy": folder / "directions.npy",
        "origins_npy": folder / "origins.npy",
        "bounds_npy": folder / "bounds.npy",
    }
    sampling, part = SAMPLING | {"directions": count}, {"seed": 0, "first": 0, "last": count}
    draw_directions(directions_npy=files["directions_npy"], sampling=sampling, seed=0)
    mesh = read_prepared(mesh_ply)
    tracer = Tracer(mesh.vertices, mesh.faces)

    def rays() -> None:
        sample_rays(**files, **part, sampling=sampling, threads=THREADS)

    rays()
    ray_set = RaySet(files["directions_npy"], [files["origins_npy"]], [files["bounds_npy"]])
    directions, origins = ray_set.directions, ray_set.origins[0]

    def trace(i: int) -> None:
        along = np.broadcast_to(directions[i], origins[i].shape)
        t, _ = tracer.first_hit(origins[i], along)
        hit = np.isfinite(t)
        behind = origins[i][hit] + (t[hit, None] + np.float32(SECOND_HIT_STEP)) * directions[i]
        tracer.first_hit(behind, along[: len(behind)])

    def cover(i: int) -> None:
        silhouette(tracer, directions[i].astype(np.float64), SAMPLING["silhouette_resolution"])

    def in_threads(work) -> None:
        with ThreadPoolExecutor(THREADS) as pool:
            list(pool.map(work, range(count)))

    subset = ray_set.gather(np.random.default_rng(0).integers(ray_set.count, size=PEER_RAYS))[:2]
    by_trimesh = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False).ray
    two_hits = {"multiple_hits": True, "max_hits": 2, "return_locations": True}
    works = {
        "rays": rays,
        "traces": lambda: in_threads(trace),
        "silhouettes": lambda: in_threads(cover),
        "trimesh": lambda: by_trimesh.intersects_id(*subset, **two_hits),
    }
    seconds = median_seconds(works, rounds)
    rate = ray_set.count / seconds["rays"]
    alone = ray_set.count / (seconds["traces"] + seconds["silhouettes"])
    peer = {"peer": "trimesh.ray, two hits", "peer_rate": PEER_RAYS / seconds["trimesh"]}
    device = f"cpu x{THREADS}"
    return [Row("rays and labels", device, rate, "samples/s", ceiling=alone, **peer)]
