"""One evaluated viewpoint and each of its parts, as an evaluation job runs it on one thread.

Five shadow maps, one network of the thesis's, untrained, and the metrics of these six methods.
An evaluation is many jobs of one thread: two of them at once give the rate of two cores.
"""

import multiprocessing
import time
from collections import defaultdict
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np
import torch
from bench_queries import FRAME, thesis_network
from measurement import Row

from neural_shadows.metrics.flip import Flip
from neural_shadows.metrics.lpips_distance import Lpips
from neural_shadows.metrics.psnr_ssim import psnr, ssim
from neural_shadows.networks.compute import choose_device, choose_dtype
from neural_shadows.networks.object_space.shadow_query import network_lit, on_device
from neural_shadows.rendering.scene_frames import open_scene
from neural_shadows.rendering.shading import reference_visibility, shade
from neural_shadows.shadow_maps.shadow_map import receivers_of, shadow_map_frame, shadow_map_lit

MAPS = (2048, 1024, 512, 256, 128)
JOBS = 2  # at once


def rows(mesh_ply: Path, trunk: Path | None, quick: bool) -> list[Row]:
    """Seconds a viewpoint, in all and in parts: medians over viewpoints of both view sets.

    Args:
        trunk: weights of LPIPS's squeeze trunk; None leaves LPIPS out.
    """
    inputs = (mesh_ply, trunk, 2 if quick else 6)
    alone = seconds_of_parts(*inputs)
    with ProcessPoolExecutor(JOBS, multiprocessing.get_context("spawn")) as pool:
        beside = list(pool.map(seconds_of_parts, *zip(*[inputs] * JOBS)))
    unit = f"s a viewpoint of {FRAME['width']} x {FRAME['height']}"
    return [
        Row("viewpoint", "cpu x1", _total(alone), unit),
        Row("viewpoint", f"cpu x{JOBS}", np.mean([_total(job) for job in beside]) / JOBS, unit),
        *(
            Row(f"viewpoint: {part}", "cpu x1", float(np.median(seconds)), unit)
            for part, seconds in alone.items()
        ),
    ]


def _total(spent: dict[str, list[float]]) -> float:
    return float(np.median(np.sum(list(spent.values()), axis=0)))


def seconds_of_parts(mesh_ply: Path, trunk: Path | None, views: int) -> dict[str, list[float]]:
    """Of each part, for each of so many viewpoints of both view sets, after one that warms up."""
    torch.set_num_threads(1)
    spent: dict[str, list[float]] = defaultdict(list)

    def timed(part, work, *inputs):
        started = time.perf_counter()
        result = work(*inputs)
        spent[part][-1] += time.perf_counter() - started
        return result

    scene = open_scene(mesh_ply, **FRAME)
    network, cpu = thesis_network(256), choose_device("cpu")
    dtype = choose_dtype("auto", cpu)
    lpips = Lpips("squeeze", trunk, device="cpu") if trunk else None

    def query(points) -> np.ndarray:
        p, light = on_device(points.p, points.light, cpu)
        return network_lit(network, p, light, dtype=dtype).numpy()

    parts = ["viewpoint drawn", "primary rays", "reference", "5 shadow maps", "network", "shading"]
    parts += ["PSNR", "SSIM", "FLIP"] + ["LPIPS"] * bool(lpips)
    for view_set in ("shadow", "surface"):
        for index in range(-1, views):
            for part in parts:
                spent[part].append(0.0)
            (view,) = timed("viewpoint drawn", scene.viewpoints, [view_set], [max(index, 0)])
            points = timed("primary rays", scene.points, view)
            lit = [timed("reference", reference_visibility, scene.tracer, points)]
            frame = timed("5 shadow maps", shadow_map_frame, scene.mesh.vertices, points.light)
            receivers = timed("5 shadow maps", receivers_of, frame, points)
            lit += [
                timed("5 shadow maps", shadow_map_lit, scene.tracer, receivers, resolution)
                for resolution in MAPS
            ]
            lit.append(timed("network", query, points))
            truth, *images = [timed("shading", shade, points, answer) for answer in lit]
            flip = timed("FLIP", Flip, truth)
            features = timed("LPIPS", lpips.features, truth) if lpips else None
            for image in images:
                timed("PSNR", psnr, image, truth)
                timed("SSIM", ssim, image, truth)
                timed("FLIP", flip.mean, image)
                if lpips:
                    timed("LPIPS", lpips.distance, image, features)
            if index < 0:
                for values in spent.values():
                    values.pop()
    return spent
