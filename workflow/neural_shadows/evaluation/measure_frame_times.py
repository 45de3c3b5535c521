"""How long a frame takes by each way of shadowing it, on one machine [4.4.1]."""

import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import torch

from neural_shadows.evaluation.shadow_methods import ShadowPass, StopwatchNetwork, shadow_passes
from neural_shadows.files.whole_files import write_json
from neural_shadows.networks.compute import choose_device, choose_dtype
from neural_shadows.networks.object_space.shadow_query import on_device, sphere_rays
from neural_shadows.networks.weight_file import load_network
from neural_shadows.rendering.gbuffer import ShadingPoints
from neural_shadows.rendering.scene_frames import open_scene
from neural_shadows.rendering.shading import shade
from neural_shadows.running.hardware import describe_machine
from neural_shadows.running.progress import progress_bar


def shadow_times(passes: Mapping[str, ShadowPass], points: ShadingPoints) -> dict[str, float]:
    """Milliseconds that shadowing and shading a frame takes, by each method in turn.

    Turns spread a disturbance of the machine over all methods.
    """
    milliseconds = {}
    for name, lit_of in passes.items():
        started = time.perf_counter()
        # A network's answer is copied to the CPU, which waits for a GPU to be done.
        shade(points, lit_of(points))
        milliseconds[name] = 1000 * (time.perf_counter() - started)
    return milliseconds


def measure_frame_times(
    mesh_ply: Path,
    weights: Mapping[str, Path],
    times_json: Path,
    *,
    scene_name: str,
    shadow_maps: Sequence[int],
    view_sets: Sequence[str],
    frames: Mapping[str, Any],
    repeats: int,
    warm_up: int,
    device: str = "auto",
    precision: str = "auto",
) -> None:
    """Time frames of a scene, ray-traced, by whole shadow maps and by networks [4.4.1].

    The frames are the first of the scene's evaluation viewpoints. CPU work has one thread,
    whatever the method, so that times compare; networks run on a GPU where there is one.

    Args:
        weights: weight files by the key of the method. A depth bias, one addition, is left out.
        frames: how they are drawn and rendered, see `open_scene`.
        repeats: timed frames of each method; `warm_up`: frames of each before those.

    Raises:
        InputError: an input file is not whole, or a setting does not fit the scene.
    """
    torch.set_num_threads(1)
    scene = open_scene(mesh_ply, **frames)
    chosen = choose_device(device)
    dtype = choose_dtype(precision, chosen)
    networks = {
        name: StopwatchNetwork(load_network(path)[0].to(chosen)) for name, path in weights.items()
    }
    passes = shadow_passes(scene.mesh, scene.tracer, networks, shadow_maps, dtype)

    per_set = -(-repeats // len(view_sets))
    viewpoints = scene.viewpoints(view_sets, range(per_set))
    viewpoints = sorted(viewpoints, key=lambda view: view.index)[:repeats]  # the sets in turn

    milliseconds: dict[str, list[float]] = {name: [] for name in passes}
    rates: dict[str, list[float]] = {name: [] for name in networks}
    rays = []
    with progress_bar(warm_up + repeats, "frames", f"frame times of {scene_name}") as bar:
        for i in range(warm_up + repeats):
            # Timed frames begin with the first viewpoint, whatever the number before them.
            view = viewpoints[(i - warm_up) % len(viewpoints)]
            started = time.perf_counter()
            points = scene.points(view)
            # The same work for every method, so timed once and counted for each.
            primary = 1000 * (time.perf_counter() - started)
            times = shadow_times(passes, points)
            if i >= warm_up:
                rays.append(len(sphere_rays(*on_device(points.p, points.light, chosen)).index))
                for name, value in times.items():
                    milliseconds[name].append(primary + value)
                for name, network in networks.items():
                    rates[name].append(network.rays / network.seconds)
            bar.update()
    write_json(
        times_json,
        {
            "scene": scene_name,
            "width": scene.width,
            "height": scene.height,
            "view_sets": list(view_sets),
            "views": len(viewpoints),
            "repeats": repeats,
            "warm_up": warm_up,
            "seed": scene.seed,
            "device": chosen.type,
            "precision": str(dtype).removeprefix("torch."),
            "cpu_threads": 1,
            "machine": describe_machine(),
            "sphere_rays": float(np.median(rays)),  # of a frame: those that a network answers
            "methods": {name: {"ms": values} for name, values in milliseconds.items()},
            "rays_per_second": rates,  # of a network's query alone, by frame
        },
    )
