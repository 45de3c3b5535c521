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
from bench_queries import HEIGHT, SCENE, SEED, WIDTH, thesis_network
from measurement import Row

from neural_shadows.evaluation.shadow_methods import network_method, traced_method
from neural_shadows.metrics.flip import flip
from neural_shadows.metrics.lpips_distance import make_lpips
from neural_shadows.metrics.psnr_ssim import psnr, ssim
from neural_shadows.networks.compute import choose_device, choose_dtype
from neural_shadows.rendering.exact_shadow import exact_visibility
from neural_shadows.rendering.gbuffer import render_gbuffer
from neural_shadows.rendering.shading import shade
from neural_shadows.rendering.viewpoints import draw_viewpoints
from neural_shadows.scenes.scene import open_scene

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
    unit = f"s a viewpoint of {WIDTH} x {HEIGHT}"
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

    scene = open_scene(mesh_ply, **SCENE)
    dtype = choose_dtype("auto", choose_device("cpu"))
    maps = [traced_method(f"shadow_map_{resolution}", scene) for resolution in MAPS]
    network = network_method(thesis_network(256), dtype)
    lpips = make_lpips("squeeze", trunk) if trunk else None

    parts = ["viewpoint drawn", "primary rays", "reference", "5 shadow maps", "network", "shading"]
    parts += ["PSNR", "SSIM", "FLIP"] + ["LPIPS"] * bool(lpips)
    for view_set in ("shadow", "surface"):
        for index in range(-1, views):
            for part in parts:
                spent[part].append(0.0)
            which = (scene, [view_set], [max(index, 0)], WIDTH / HEIGHT, SEED)
            (view,) = timed("viewpoint drawn", draw_viewpoints, *which)
            frame = timed("primary rays", render_gbuffer, scene, view, WIDTH, HEIGHT)
            answers = [timed("reference", exact_visibility, scene.tracer, frame)]
            answers += [timed("5 shadow maps", method, frame) for method in maps]
            answers.append(timed("network", network, frame))
            truth, *images = [timed("shading", shade, frame, answer) for answer in answers]
            for image in images:
                timed("PSNR", psnr, image, truth)
                timed("SSIM", ssim, image, truth)
                timed("FLIP", flip, image, truth)
                if lpips:
                    timed("LPIPS", lpips, image, truth)
            if index < 0:
                for values in spent.values():
                    values.pop()
    return spent
