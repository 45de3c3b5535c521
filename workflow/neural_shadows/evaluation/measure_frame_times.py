"""The stage that times a frame by each way of shadowing it, on one machine [4.4.1]."""

import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import torch
from torch import Tensor

from neural_shadows.evaluation.method_names import experiment_of
from neural_shadows.evaluation.shadow_methods import (
    ShadowMethod,
    network_method,
    open_network,
    traced_method,
)
from neural_shadows.files.whole_files import write_json
from neural_shadows.networks.compute import choose_device, choose_dtype
from neural_shadows.networks.object_space.shadow_network import ShadowNetwork
from neural_shadows.networks.object_space.shadow_query import on_device, sphere_rays
from neural_shadows.rendering.gbuffer import render_gbuffer
from neural_shadows.rendering.shading import shade
from neural_shadows.rendering.viewpoints import draw_viewpoints
from neural_shadows.running.hardware import describe_machine
from neural_shadows.running.progress import progress_bar
from neural_shadows.running.stage import run_stage
from neural_shadows.scenes.scene import open_scene

WARM_UP = 2  # frames of each method before the timed ones


def record_rates(network: ShadowNetwork, rates: list[float]) -> ShadowNetwork:
    """The network, each of whose queries now adds its rays a second to `rates`."""
    depths = network.depths

    def timed(origins: Tensor, d: Tensor, dtype: torch.dtype) -> Tensor:
        started = time.perf_counter()
        answer = depths(origins, d, dtype)
        if answer.is_cuda:
            torch.cuda.synchronize()
        rates.append(len(origins) / (time.perf_counter() - started))
        return answer

    network.depths = timed
    return network


def measure_frame_times(
    mesh_ply: Path,
    weights: list[Path],
    times_json: Path,
    *,
    methods: Sequence[str],
    scene: Mapping[str, Any],
    frames: Mapping[str, Any],
    frame_times: Mapping[str, int],
    device: str = "auto",
) -> None:
    """Time frames of a scene by each method: rays, whole shadow maps, networks [4.4.1].

    The frames are the first of the scene's evaluation viewpoints. CPU work has one thread,
    whatever the method, so that times compare; networks run on a GPU where there is one.

    Args:
        weights: of the networks, in the folder of their experiment each.
        times_json: named for the scene.
        methods: keys, `ray_traced`, `shadow_map_N` and of networks. A depth bias, one addition,
            is left out.
        scene: `up`, `ground` and `light`, see `open_scene`.
        frames: `view_sets` and `seed` of the evaluation's frames; they have another size.
        frame_times: `width`, `height` (pixels) and `repeats`, timed frames of each method.

    Raises:
        InputError: an input file cannot be read, or a setting does not fit the scene.
    """
    torch.set_num_threads(1)
    opened = open_scene(mesh_ply, **scene)
    chosen = choose_device(device)
    files = {path.parent.name: path for path in weights}
    rates: dict[str, list[float]] = {}
    timed: dict[str, ShadowMethod] = {}
    for method in methods:
        if file := files.get(experiment_of(method)):
            network, dtype = open_network(file, device, 1)
            rates[method] = []
            timed[method] = network_method(record_rates(network, rates[method]), dtype)
        else:
            timed[method] = traced_method(method, opened, whole_map=True)

    width, height, repeats = (frame_times[key] for key in ("width", "height", "repeats"))
    view_sets, seed = frames["view_sets"], frames["seed"]
    per_set = range(-(-repeats // len(view_sets)))
    viewpoints = draw_viewpoints(opened, view_sets, per_set, width / height, seed)
    viewpoints = sorted(viewpoints, key=lambda view: view.index)[:repeats]  # the sets in turn

    milliseconds: dict[str, list[float]] = {method: [] for method in timed}
    rays = []
    with progress_bar(WARM_UP + repeats, "frames", f"measure times of {times_json.stem}") as bar:
        for i in range(-WARM_UP, repeats):
            view = viewpoints[i % len(viewpoints)]
            started = time.perf_counter()
            frame = render_gbuffer(opened, view, width, height)
            # The same work for every method, so timed once and counted for each.
            primary = time.perf_counter() - started
            # In turn, which spreads a disturbance of the machine over all methods.
            for method, answer in timed.items():
                started = time.perf_counter()
                shade(frame, answer(frame))  # the answer is on the CPU, so that a GPU is done
                seconds = primary + time.perf_counter() - started
                milliseconds[method].append(1000 * seconds)
            rays.append(len(sphere_rays(*on_device(frame.p, view.light, chosen)).index))
            bar.update()
    write_json(
        times_json,
        {
            "scene": times_json.stem,
            **frame_times,
            "views": len(viewpoints),
            "warm_up": WARM_UP,
            "device": chosen.type,
            "precision": str(choose_dtype("auto", chosen)).removeprefix("torch."),
            "machine": describe_machine(),
            "sphere_rays": float(np.median(rays[WARM_UP:])),  # those that a network answers
            "methods": {name: {"ms": values[WARM_UP:]} for name, values in milliseconds.items()},
            # of a network's query alone, by frame
            "rays_per_second": {method: found[WARM_UP:] for method, found in rates.items()},
        },
    )


if "snakemake" in globals():
    run_stage(snakemake, measure_frame_times)
