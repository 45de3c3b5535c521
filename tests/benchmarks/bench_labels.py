"""Labelled samples per second of the sampling and label stages, beside Embree alone and trimesh.

    python tests/benchmarks/bench_labels.py --mesh dragon.ply [--directions 500] [--points 10000]

Per round, one after another so that all see the same machine: both stages as the pipeline runs
them, reading the mesh and writing files included; Embree alone, in as many threads, on the same
rays: the first and the second hits and nothing else (the ceiling of the labels), and the
silhouettes' occlusion rays with them (the ceiling of both stages); and trimesh's multi-hit query,
two hits of some of these rays. Prints medians over the rounds, and ratios.
"""

import argparse
import tempfile
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import trimesh

from neural_shadows.hardware import processor_name
from neural_shadows.labels import SECOND_HIT_STEP
from neural_shadows.mesh import prepare_mesh, read_prepared
from neural_shadows.ray_files import make_labels, make_rays
from neural_shadows.ray_set import RaySet
from neural_shadows.silhouette import silhouette
from neural_shadows.tracing import Tracer
from neural_shadows.view_directions import make_directions

PEER_RAYS = 100_000


def seconds(work: Callable[[], object]) -> float:
    started = time.perf_counter()
    work()
    return time.perf_counter() - started


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--mesh", type=Path, required=True, help="PLY, OBJ, STL or GLB, or .gz")
    parser.add_argument("--directions", type=int, default=500)
    parser.add_argument("--points", type=int, default=10_000)
    parser.add_argument("--resolution", type=int, default=128, help="of silhouettes, in texels")
    parser.add_argument("--min-quad", type=int, default=1)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--rounds", type=int, default=3)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        compare(arguments, Path(folder))


def compare(arguments: argparse.Namespace, folder: Path) -> None:
    mesh_ply, directions_npy = folder / "mesh.ply", folder / "directions.npy"
    origins_npy, bounds_npy = folder / "origins.npy", folder / "bounds.npy"
    prepare_mesh(arguments.mesh, mesh_ply, folder / "mesh.json", name="benchmark")
    make_directions(
        directions_npy, sampler="poisson_quadtree", directions=arguments.directions, seed=0
    )

    def start() -> Tracer:
        prepared = read_prepared(mesh_ply)
        return Tracer(prepared.vertices, prepared.faces)

    mesh, tracer = read_prepared(mesh_ply), start()
    peer = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False).ray
    part = {"first": 0, "last": arguments.directions, "threads": arguments.threads}

    def rays() -> None:
        make_rays(
            mesh_ply,
            directions_npy,
            origins_npy,
            sampler="poisson_quadtree",
            points_per_direction=arguments.points,
            silhouette_resolution=arguments.resolution,
            min_quad=arguments.min_quad,
            seed=0,
            **part,
        )

    def labels() -> None:
        make_labels(mesh_ply, directions_npy, origins_npy, bounds_npy, **part)

    def in_threads(work: Callable[[int], None]) -> None:
        with ThreadPoolExecutor(arguments.threads) as pool:
            list(pool.map(work, range(arguments.directions)))

    rays()  # the first calls compile, and make the rays that Embree and trimesh get
    labels()
    ray_set = RaySet(directions_npy, [origins_npy], [bounds_npy])
    directions, origins, bounds = ray_set.directions, ray_set.origins[0], ray_set.bounds[0]

    def trace(i: int) -> None:
        along = np.broadcast_to(directions[i], origins[i].shape)
        t, _ = tracer.first_hit(origins[i], along)
        hit = np.isfinite(t)
        behind = origins[i][hit] + (t[hit, None] + np.float32(SECOND_HIT_STEP)) * directions[i]
        tracer.first_hit(behind, along[: len(behind)])

    def cover(i: int) -> None:
        silhouette(tracer, directions[i].astype(np.float64), arguments.resolution)

    subset = np.random.default_rng(0).integers(ray_set.count, size=PEER_RAYS)
    peer_origins, peer_directions, _, _ = ray_set.gather(subset)

    def two_hits() -> None:
        peer.intersects_id(
            peer_origins, peer_directions, multiple_hits=True, max_hits=2, return_locations=True
        )

    two_hits()  # builds trimesh's tree
    times: dict[str, list[float]] = {}
    for _ in range(arguments.rounds):
        for name, work in [
            ("start", start),
            ("rays", rays),
            ("labels", labels),
            ("traces", lambda: in_threads(trace)),
            ("silhouettes", lambda: in_threads(cover)),
            ("trimesh", two_hits),
        ]:
            times.setdefault(name, []).append(seconds(work))

    def rate(*names: str, count: int = ray_set.count) -> float:
        return count / np.median(np.sum([times[name] for name in names], axis=0))

    both, ceiling = rate("rays", "labels"), rate("traces", "silhouettes")
    single_thread = rate("trimesh", count=PEER_RAYS)
    hits = np.isfinite(bounds[..., 1]).mean()
    print(f"{processor_name()}, {arguments.threads} threads, median of {arguments.rounds} rounds")
    print(
        f"{arguments.mesh.name}: {len(mesh.faces):,} triangles, {arguments.directions} directions "
        f"x {arguments.points:,} points, {hits:.0%} of the rays hit twice"
    )
    print(f"rays and labels: {both:,.0f} samples/s")
    print(f"rays: {rate('rays'):,.0f} samples/s, labels: {rate('labels'):,.0f} samples/s")
    print(f"mesh and tree, in each of both stages: {np.median(times['start']):.2f} s")
    print(f"Embree alone, the same hits: {rate('traces'):,.0f} samples/s")
    print(f"Embree alone, the same hits and silhouettes: {ceiling:,.0f} samples/s")
    print(f"trimesh's multi-hit, {PEER_RAYS:,} rays, one thread: {single_thread:,.0f} samples/s")
    print(
        f"share of Embree's rate: {both / ceiling:.0%}, labels {rate('labels') / rate('traces'):.0%}"
    )
    print(f"ratio of labels to trimesh's multi-hit: {rate('labels') / single_thread:.1f}")


if __name__ == "__main__":
    main()
