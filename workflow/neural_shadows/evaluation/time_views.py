"""Times of methods on views under a sun [4.4.1]."""

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import torch

from neural_shadows.evaluation.frame import Inputs
from neural_shadows.evaluation.memory import stored_bytes
from neural_shadows.evaluation.ray_network import open_network
from neural_shadows.evaluation.registry import classic_method, is_network, unbiased
from neural_shadows.networks.compute import choose_device, choose_dtype, finished
from neural_shadows.networks.object_space.shadow_network import ShadowNetwork
from neural_shadows.networks.object_space.shadow_query import on_device
from neural_shadows.networks.object_space.sphere_rays import sphere_rays
from neural_shadows.rendering.gbuffer import GBuffer, render_gbuffer
from neural_shadows.rendering.shading import shade
from neural_shadows.rendering.viewpoints import draw_viewpoints
from neural_shadows.running.progress import progress_bar
from neural_shadows.scenes.scene import Scene, open_scene
from neural_shadows.settings.records import FrameTimesSettings, ViewSettings

WARM_UP = 2  # frames of each method before the timed ones


@dataclass(frozen=True)
class TimedMethod:
    """A method with the time of its part of a frame."""

    # Of a frame: its visibility (n,), on the CPU, and the seconds of the method alone.
    answer: Callable[[GBuffer], tuple[np.ndarray, float]]
    device: str  # `cpu` or `cuda`
    resident_bytes: int | None  # of its own in memory; None without any


def timed_classic(method: str, scene: Scene) -> TimedMethod:
    """A method without a network. A shadow map is rasterised whole for each frame."""
    frame_method = classic_method(method, scene, whole_map=True)

    def answer(frame: GBuffer) -> tuple[np.ndarray, float]:
        started = time.perf_counter()
        visibility = frame_method(frame)(0.0)
        return visibility, time.perf_counter() - started

    return TimedMethod(answer, "cpu", stored_bytes(method))


def timed_network(network: ShadowNetwork, dtype: torch.dtype) -> TimedMethod:
    """A network, timed from points to visibility.

    On a GPU to the mask there, as a GPU would shade there too. On a CPU it is the same work as a
    map's.
    """

    def answer(frame: GBuffer) -> tuple[np.ndarray, float]:
        p, light = on_device(frame.p, frame.view.light, network.device)
        started = finished(network.device)
        lit = network.points_lit(p, light, dtype)(0.0)
        ended = finished(network.device)
        visibility = frame.visibility(lit.cpu().numpy())
        if network.device.type == "cpu":
            ended = time.perf_counter()
        return visibility, ended - started

    return TimedMethod(answer, network.device.type, network.resident_bytes())


def times(
    inputs: Inputs,
    methods: Mapping[str, str | None],
    views: ViewSettings,
    frame_times: FrameTimesSettings,
) -> dict[str, Any]:
    """Time rays, whole shadow maps and networks on a scene.

    The frames are the first of the scene's evaluation viewpoints. CPU work has one thread,
    whatever the method, so that times compare; networks run on a GPU where there is one, and then
    compare with each other alone: primary visibility, maps and shading stay on the CPU.

    Args:
        inputs: the scene's mesh and settings, weights of networks, device and precision.
        methods: the experiment of each, or None. A depth bias, one addition, is left out: with and
            without it a network is timed once.
        views: `view_sets`, `seed`, `least_shadow` of the evaluation's frames; they have another size.

    Returns: of each method `ms` of whole frames, `own_ms` without primary visibility and shading, and
        the rest of `TimedMethod`.

    Raises:
        InputError: an input file cannot be read, or a setting does not fit the scene.
    """
    opened = open_scene(*inputs.meshes, **inputs.scene)
    chosen = choose_device(inputs.device)
    files = {path.parent.name: path for path in inputs.weights}
    timed = {
        method: timed_network(*open_network(files[name], inputs.device, 1, inputs.precision))
        if is_network(method)
        else timed_classic(method, opened)
        for method, name in {unbiased(key): name for key, name in methods.items()}.items()
    }

    width, height, repeats = (frame_times[key] for key in ("width", "height", "repeats"))
    view_sets, drawn = views["view_sets"], (views["seed"], views.get("least_shadow", 0.0))
    per_set = range(-(-repeats // len(view_sets)))
    viewpoints = draw_viewpoints(opened, view_sets, per_set, width / height, *drawn)
    viewpoints = sorted(viewpoints, key=lambda view: view.index)[:repeats]  # the sets in turn

    title = f"time methods on {inputs.meshes[0].parent.name}"
    whole: dict[str, list[float]] = {method: [] for method in timed}
    own: dict[str, list[float]] = {method: [] for method in timed}
    rays = []
    with progress_bar(WARM_UP + repeats, "frames", title) as bar:
        for i in range(-WARM_UP, repeats):
            view = viewpoints[i % len(viewpoints)]
            started = time.perf_counter()
            frame = render_gbuffer(opened, view, width, height)
            # The same work for every method, so timed once and counted for each.
            primary = time.perf_counter() - started
            # In turn, which spreads a disturbance of the machine over all methods.
            for name, method in timed.items():
                started = time.perf_counter()
                visibility, seconds = method.answer(frame)
                shade(frame, visibility)
                whole[name].append(primary + time.perf_counter() - started)
                own[name].append(seconds)
            rays.append(len(sphere_rays(*on_device(frame.p, view.light, chosen)).index))
            bar.update()
    rays = np.array(rays[WARM_UP:])
    return {
        "scene": inputs.meshes[0].parent.name,
        **frame_times,
        "views": len(viewpoints),
        "warm_up": WARM_UP,
        "device": chosen.type,
        "precision": str(choose_dtype(inputs.precision, chosen)).removeprefix("torch."),
        "sphere_rays": float(np.median(rays)),  # a network's
        "methods": {
            key: {
                "ms": [1000 * seconds for seconds in whole[name][WARM_UP:]],
                "own_ms": [1000 * seconds for seconds in own[name][WARM_UP:]],
                "device": timed[name].device,
                "resident_bytes": timed[name].resident_bytes,
            }
            for key, name in zip(methods, map(unbiased, methods))
        },
        # of a network's own time, by frame
        "rays_per_second": {
            key: (rays / own[unbiased(key)][WARM_UP:]).tolist()
            for key in filter(is_network, methods)
        },
    }
