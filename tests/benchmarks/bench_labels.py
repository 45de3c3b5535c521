"""Rays and labels: both stages as the pipeline runs them, beside Embree alone and two libraries.

Embree alone, in as many threads, traces the same first and second hits, and for the ceiling of
both stages the silhouettes' occlusion rays with them. Its rate is the ceiling.
"""

import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import trimesh
from measurement import Row, median_seconds

from neural_shadows.meshes.prepared_mesh import read_prepared
from neural_shadows.rays.draw_directions import draw_directions
from neural_shadows.rays.label_rays import label_rays
from neural_shadows.rays.labels import SECOND_HIT_STEP
from neural_shadows.rays.ray_set import RaySet
from neural_shadows.rays.sample_rays import sample_rays
from neural_shadows.rays.silhouette import silhouette
from neural_shadows.scenes.tracing import Tracer

POINTS = 10_000  # of a direction, as in the thesis [4.1]
RESOLUTION = 128  # of the silhouettes
THREADS = 2
PEER_RAYS = 100_000


def rows(mesh_ply: Path, quick: bool) -> list[Row]:
    """Rates of the two stages and of their peers."""
    with tempfile.TemporaryDirectory() as folder:
        return _rows(mesh_ply, Path(folder), 100 if quick else 500, 3)


def _rows(mesh_ply: Path, folder: Path, count: int, rounds: int) -> list[Row]:
    files = {
        "mesh_ply": mesh_ply,
        "directions_npy": folder / "directions.npy",
        "origins_npy": folder / "origins.npy",
    }
    sampling = {
        "sampler": "poisson_quadtree",
        "directions": count,
        "points_per_direction": POINTS,
        "silhouette_resolution": RESOLUTION,
        "min_quad": 1,
    }
    draw_directions(directions_npy=files["directions_npy"], sampling=sampling, seed=0)
    mesh = read_prepared(mesh_ply)
    tracer = Tracer(mesh.vertices, mesh.faces)
    part = {"seed": 0, "first": 0, "last": count, "threads": THREADS}

    def rays() -> None:
        sample_rays(**files, sampling=sampling, **part)

    def labels() -> None:
        label_rays(**files, bounds_npy=folder / "bounds.npy", **part)

    rays()
    labels()
    ray_set = RaySet(files["directions_npy"], [files["origins_npy"]], [folder / "bounds.npy"])
    directions, origins = ray_set.directions, ray_set.origins[0]

    def trace(i: int) -> None:
        along = np.broadcast_to(directions[i], origins[i].shape)
        t, _ = tracer.first_hit(origins[i], along)
        hit = np.isfinite(t)
        behind = origins[i][hit] + (t[hit, None] + np.float32(SECOND_HIT_STEP)) * directions[i]
        tracer.first_hit(behind, along[: len(behind)])

    def cover(i: int) -> None:
        silhouette(tracer, directions[i].astype(np.float64), RESOLUTION)

    def in_threads(work) -> None:
        with ThreadPoolExecutor(THREADS) as pool:
            list(pool.map(work, range(count)))

    subset = np.random.default_rng(0).integers(ray_set.count, size=PEER_RAYS)
    some = ray_set.gather(subset)[:2]
    peers = {"trimesh.ray": _trimesh_two_hits(mesh, *some)}
    try:
        peers["Open3D"] = _open3d_two_hits(mesh, *some)
    except ImportError:
        print("Open3D is left out: pip install -r envs/benchmarks.txt")
    seconds = median_seconds(
        {
            "rays": rays,
            "labels": labels,
            "traces": lambda: in_threads(trace),
            "silhouettes": lambda: in_threads(cover),
            **peers,
        },
        rounds,
    )
    both = ray_set.count / (seconds["rays"] + seconds["labels"])
    alone = ray_set.count / (seconds["traces"] + seconds["silhouettes"])
    rate = {name: ray_set.count / seconds[name] for name in ("rays", "labels", "traces")}
    unit = "samples/s"
    return [
        Row("rays and labels", f"cpu x{THREADS}", both, unit, ceiling=alone),
        Row("rays", f"cpu x{THREADS}", rate["rays"], unit),
        *(
            Row(
                "labels",
                f"cpu x{THREADS}",
                rate["labels"],
                unit,
                ceiling=rate["traces"],
                peer=f"{peer}, two hits",
                peer_rate=PEER_RAYS / seconds[peer],
            )
            for peer in peers
        ),
    ]


def _trimesh_two_hits(mesh, origins, directions):
    ray = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False).ray
    return lambda: ray.intersects_id(
        origins, directions, multiple_hits=True, max_hits=2, return_locations=True
    )


def _open3d_two_hits(mesh, origins, directions):
    import open3d as o3d

    scene = o3d.t.geometry.RaycastingScene(nthreads=THREADS)
    scene.add_triangles(
        o3d.core.Tensor(mesh.vertices), o3d.core.Tensor(mesh.faces.astype(np.uint32))
    )

    def two_hits() -> None:
        rays = np.concatenate([origins, directions], axis=1)
        t = scene.cast_rays(o3d.core.Tensor(rays), nthreads=THREADS)["t_hit"].numpy()
        hit = np.isfinite(t)
        behind = rays[hit]
        behind[:, :3] += (t[hit, None] + np.float32(SECOND_HIT_STEP)) * behind[:, 3:]
        scene.cast_rays(o3d.core.Tensor(behind), nthreads=THREADS)

    return two_hits
