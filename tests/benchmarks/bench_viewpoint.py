"""Seconds of each part of one evaluated viewpoint, at the desk scale's frame size.

    python tests/benchmarks/bench_viewpoint.py --mesh results/scenes/dragon/mesh.ply \
        --weights results/networks/dragon/weights.safetensors [--trunk squeeze.backbone.pth]

Five shadow maps, one network and the metrics of these six methods, on one thread, as an
evaluation job runs them. Prints medians over the viewpoints, and each part's share.
"""

import argparse
import time
from collections import defaultdict
from pathlib import Path

import numpy as np
import torch

from neural_shadows.compute import choose_device, choose_dtype
from neural_shadows.frames import reference_visibility, shade
from neural_shadows.hardware import processor_name
from neural_shadows.metrics import Lpips, flip, psnr, ssim
from neural_shadows.network_file import load_network
from neural_shadows.scene_frames import open_scene
from neural_shadows.shadow_map import receivers_of, shadow_map_frame, shadow_map_lit
from neural_shadows.shadow_query import network_lit

MAPS = (2048, 1024, 512, 256, 128)
LIGHT = {"domain": "sphere", "min_elevation_deg": 20}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--mesh", type=Path, required=True, help="a prepared mesh")
    parser.add_argument("--weights", type=Path, required=True)
    parser.add_argument("--trunk", type=Path, help="LPIPS's squeeze trunk; without it no LPIPS")
    parser.add_argument("--width", type=int, default=600)
    parser.add_argument("--height", type=int, default=400)
    parser.add_argument("--views", type=int, default=6, help="of each view set")
    arguments = parser.parse_args()
    torch.set_num_threads(1)
    spent = defaultdict(list)

    def timed(part, work, *inputs):
        started = time.perf_counter()
        result = work(*inputs)
        spent[part][-1] += time.perf_counter() - started
        return result

    size = arguments.width, arguments.height
    scene = open_scene(
        arguments.mesh, up="y", ground=True, light=LIGHT, width=size[0], height=size[1], seed=2026
    )
    tracer = scene.tracer
    network = load_network(arguments.weights)[0]
    dtype = choose_dtype("auto", choose_device("cpu"))
    lpips = Lpips("squeeze", arguments.trunk, device="cpu") if arguments.trunk else None
    for view_set in ("shadow", "surface"):
        for index in range(-1, arguments.views):  # the first one warms up
            parts = ("viewpoint", "primary rays", "reference", "5 shadow maps", "network")
            for part in (*parts, "shading", "PSNR", "SSIM", "FLIP", "LPIPS"):
                spent[part].append(0.0)
            (view,) = timed(
                "viewpoint",
                lambda index=index, view_set=view_set: scene.viewpoints(
                    [view_set], [max(index, 0)]
                ),
            )
            points = timed("primary rays", scene.points, view)
            lit = [timed("reference", reference_visibility, tracer, points)]
            frame = timed("5 shadow maps", shadow_map_frame, scene.mesh.vertices, points.light)
            receivers = timed("5 shadow maps", receivers_of, frame, points)
            lit += [timed("5 shadow maps", shadow_map_lit, tracer, receivers, n) for n in MAPS]
            lit.append(
                timed(
                    "network",
                    lambda points=points: network_lit(network, points.p, points.light, dtype=dtype),
                )
            )
            truth, *images = [timed("shading", shade, points, answer) for answer in lit]
            features = timed("LPIPS", lpips.features, truth) if lpips else None
            for image in images:
                timed("PSNR", psnr, image, truth)
                timed("SSIM", ssim, image, truth)
                timed("FLIP", flip, image, truth)
                if lpips:
                    timed("LPIPS", lpips.distance, image, features)
            if index < 0:
                for values in spent.values():
                    values.pop()

    total = np.median(np.sum(list(spent.values()), axis=0))
    views = len(spent["network"])
    print(f"{processor_name()}, one thread, {views} viewpoints of {size[0]} × {size[1]}, {dtype}")
    for part, values in spent.items():
        median = np.median(values)
        print(f"{part:14} {median:7.3f} s {100 * median / total:5.1f} %")
    print(f"{'one viewpoint':14} {total:7.3f} s")


if __name__ == "__main__":
    main()
