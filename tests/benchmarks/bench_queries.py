"""Rays/s of networks' queries on the same frames, as ratios to the first network's.

    python tests/benchmarks/bench_queries.py --mesh results/scenes/dragon/mesh.ply \
        results/networks/dragon/weights.safetensors results/networks/dragon_field/weights.safetensors

One thread, the light's rays of 1200 × 800 frames, networks in turn; median over the frames. An
occupancy field is also asked in its plain form, which looks at every sample of every ray.
"""

import argparse
import time
from pathlib import Path

import numpy as np
import torch

from neural_shadows.compute import choose_device, choose_dtype
from neural_shadows.hardware import processor_name
from neural_shadows.network_file import load_network
from neural_shadows.occupancy_field_network import OccupancyFieldNetwork
from neural_shadows.scene_frames import open_scene
from neural_shadows.shadow_network import ShadowNetwork
from neural_shadows.shadow_query import sphere_rays

LIGHT = {"domain": "sphere", "min_elevation_deg": 20}
PLAIN_RAYS = 4096


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("weights", type=Path, nargs="+")
    parser.add_argument("--mesh", type=Path, required=True, help="a prepared mesh")
    parser.add_argument("--no-ground", action="store_true")
    parser.add_argument("--views", type=int, default=4)
    arguments = parser.parse_args()
    torch.set_num_threads(1)
    dtype = choose_dtype("auto", choose_device("cpu"))
    scene = open_scene(
        arguments.mesh,
        up="y",
        ground=not arguments.no_ground,
        light=LIGHT,
        width=1200,
        height=800,
        seed=2026,
    )
    networks = {path.parent.name: load_network(path)[0] for path in arguments.weights}
    rates: dict[str, list[float]] = {}

    def timed(name: str, rays: int, work, *inputs) -> None:
        started = time.perf_counter()
        work(*inputs)
        rates.setdefault(name, []).append(rays / (time.perf_counter() - started))

    for view in scene.viewpoints(["surface"], range(arguments.views + 1)):  # the first one warms up
        points = scene.points(view)
        origins = sphere_rays(points.p, points.light).origins
        d = -points.light.astype(np.float32)
        for name, network in networks.items():
            timed(name, len(origins), network.depths, origins, d, dtype)
            if isinstance(network, OccupancyFieldNetwork):
                some = origins[:: max(1, len(origins) // PLAIN_RAYS)]
                plain = ShadowNetwork.depths
                timed(f"{name}, plain", len(some), plain, network, some, d, dtype)
    first = np.median(next(iter(rates.values()))[1:])
    print(f"{processor_name()}, one thread, {dtype}, median of {arguments.views} frames")
    for name, values in rates.items():
        rate = np.median(values[1:])
        print(f"{name:40} {rate / 1e6:8.3f} M rays/s {rate / first:8.2f} times the first")


if __name__ == "__main__":
    main()
