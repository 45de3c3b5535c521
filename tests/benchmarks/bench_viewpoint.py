"""One evaluated viewpoint and each of its parts, as evaluation jobs run them on one thread.

Five shadow maps, one network of the thesis's, untrained, and the metrics of these six methods.
An evaluation is many jobs of one thread: two of them at once give the rate of two cores. And whole
maps as frames are timed with: rasterised, beside a ray a texel.
"""

import multiprocessing
import time
from collections import defaultdict
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import torch
from bench_queries import HEIGHT, SCENE, SEED, WIDTH, thesis_network
from measurement import Row, median_seconds

from neural_shadows.evaluation.method import ShadowMethod
from neural_shadows.evaluation.ray_network import network_method
from neural_shadows.evaluation.registry import classic_method
from neural_shadows.metrics.find_lpips import export_onnx, load_model
from neural_shadows.metrics.kinds.flip import flip
from neural_shadows.metrics.kinds.lpips import with_model
from neural_shadows.metrics.kinds.psnr import psnr
from neural_shadows.metrics.kinds.ssim import ssim
from neural_shadows.networks.compute import choose_device, choose_dtype
from neural_shadows.rendering.exact_shadow import exact_visibility
from neural_shadows.rendering.gbuffer import GBuffer, render_gbuffer
from neural_shadows.rendering.shading import shade
from neural_shadows.rendering.viewpoints import draw_viewpoints
from neural_shadows.scenes.scene import open_scene
from neural_shadows.shadow_maps.rasterise import rasterised_heights
from neural_shadows.shadow_maps.shadow_map import shadow_map_square
from neural_shadows.shadow_maps.trace import texel_heights

MAPS = (2048, 1024, 512, 256, 128)
JOBS = 2  # at once
RASTERISED, TRACED = "rasterised", "a ray a texel"


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
        *whole_maps(mesh_ply, 3 if quick else 9),
    ]


def whole_maps(mesh_ply: Path, rounds: int) -> list[Row]:
    """Whole maps a second, of sizes that frames are timed with: rasterised, and traced."""
    scene = open_scene(mesh_ply, **SCENE)
    (mesh,), light = scene.objects, np.array([2, 6, 3]) / 7
    square = shadow_map_square(mesh.vertices, light)
    found = []
    for n in MAPS[:3]:
        works = {
            RASTERISED: partial(rasterised_heights, mesh.vertices, mesh.faces, square, n),
            TRACED: partial(texel_heights, scene.tracer, square, n, np.arange(n * n)),
        }
        seconds = median_seconds(works, rounds)
        rate = {name: 1 / value for name, value in seconds.items()}
        stage = f"whole map of {n} x {n}, {RASTERISED}"
        traced = {"peer": TRACED, "peer_rate": rate[TRACED]}
        found.append(Row(stage, "cpu x1", rate[RASTERISED], "maps/s", **traced))
    return found


def unbiased(method: ShadowMethod) -> Callable[[GBuffer], np.ndarray]:
    """A method's visibility without a depth bias."""
    return lambda frame: method(frame)(0.0)


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
    maps = [unbiased(classic_method(f"shadow_map_{resolution}", scene)) for resolution in MAPS]
    network = unbiased(network_method(thesis_network(256), dtype))
    lpips = None
    if trunk:
        with TemporaryDirectory() as folder:
            lpips_onnx = Path(folder) / "lpips.onnx"
            export_onnx(load_model("squeeze", trunk), lpips_onnx)
            lpips = with_model(lpips_onnx, threads=1)

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
