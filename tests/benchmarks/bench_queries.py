"""Network queries of a frame's rays, beside eager float32 and the exact answer of Embree.

The ceiling is the rate of the layers' matrix products in our number format. On two threads each
answers half of the frame, as two evaluation jobs side by side do.
"""

from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import torch
from measurement import Row, Work, median_seconds, name_of
from torch import Tensor

from neural_shadows.networks.compute import choose_device, choose_dtype
from neural_shadows.networks.object_space.frequency_network import FrequencyNetwork
from neural_shadows.networks.object_space.shadow_network import QUERY_CHUNKS
from neural_shadows.networks.object_space.shadow_query import on_device
from neural_shadows.networks.object_space.sphere_rays import sphere_rays
from neural_shadows.networks.weight_file import load_network
from neural_shadows.rendering.exact_shadow import exact_visibility
from neural_shadows.rendering.gbuffer import render_gbuffer
from neural_shadows.rendering.viewpoints import draw_viewpoints
from neural_shadows.scenes.scene import open_scene

WIDTHS = (256, 128, 64)
SCENE = {"up": "y", "ground": True, "light": {"domain": "sphere", "min_elevation_deg": 20}}
WIDTH, HEIGHT, SEED = 1200, 800, 2026

EAGER, EMBREE = "eager float32, whole frame", "Embree's occlusion rays"
THESIS = "the thesis's network, width 256"


def rows(mesh_ply: Path, weights: Sequence[Path], quick: bool) -> list[Row]:
    """Rates of untrained networks of the thesis's widths, and of trained ones of any kind.

    Args:
        weights: of trained networks, beside which the 256-wide one stands as a peer.
    """
    torch.set_num_threads(1)
    cpu = choose_device("cpu")
    dtype = choose_dtype("auto", cpu)
    scene = open_scene(mesh_ply, **SCENE)
    (view,) = draw_viewpoints(scene, ["surface"], [0], WIDTH / HEIGHT, SEED)
    frame = render_gbuffer(scene, view, WIDTH, HEIGHT)
    points, light = on_device(frame.p, view.light, cpu)
    d = -light
    origins = sphere_rays(points, light).origins
    rounds = 2 if quick else 5

    result = []
    for width in WIDTHS:
        network = thesis_network(width)
        works = {
            "ours": lambda network=network: network.depths(origins, d, dtype),
            "halves": _two_halves(network, origins, d, dtype),
            EAGER: lambda network=network: _eager(network, origins, d),
            EMBREE: lambda: exact_visibility(scene.tracer, frame),
            "products": products(network, dtype, len(origins)),
        }
        seconds = median_seconds(works, rounds)
        rays = dict.fromkeys(works, len(origins)) | {EMBREE: len(points)}
        rate = {name: rays[name] / seconds[name] for name in works}
        stage = f"query, width {width}, {name_of(dtype)}"
        result += [
            Row(stage, "cpu x1", rate["ours"], "rays/s", rate["products"], peer, rate[peer])
            for peer in (EAGER, EMBREE)
        ]
        result.append(Row(stage, "cpu x2", rate["halves"], "rays/s", 2 * rate["products"]))

    trained = {path.parent.name: load_network(path)[0] for path in weights}
    works = {
        name: lambda network=network: network.depths(origins, d, dtype)
        for name, network in {THESIS: thesis_network(256), **trained}.items()
        if trained
    }
    rate = {name: len(origins) / value for name, value in median_seconds(works, rounds).items()}
    return result + [
        Row(f"query, {name}", "cpu x1", rate[name], "rays/s", peer=THESIS, peer_rate=rate[THESIS])
        for name in trained
    ]


def thesis_network(width: int) -> FrequencyNetwork:
    """An untrained network: the rate does not depend on its weights."""
    network = FrequencyNetwork(frequencies=10, width=width, hidden_layers=8)
    network.initialise(0)
    return network


def _eager(network: FrequencyNetwork, origins: Tensor, d: Tensor) -> None:
    with torch.inference_mode():
        network(origins, d.expand(len(origins), 3), torch.float32)


def _two_halves(network: FrequencyNetwork, origins: Tensor, d: Tensor, dtype: torch.dtype) -> Work:
    halves = origins.chunk(2)
    pool = ThreadPoolExecutor(2, initializer=torch.set_num_threads, initargs=(1,))
    return lambda: list(pool.map(lambda half: network.depths(half, d, dtype), halves))


def products(network: FrequencyNetwork, dtype: torch.dtype, rays: int) -> Work:
    """The matrix products of a query, forward alone, on the network's device."""
    rows, device = QUERY_CHUNKS[network.device.type], network.device
    layers = [
        (torch.randn(rows, weight.shape[1], device=device).to(dtype), weight.detach().to(dtype).t())
        for weight in network.layers
    ]

    def multiply() -> None:
        for _ in range(rays // rows):
            for x, weight in layers:
                torch.mm(x, weight)

    return multiply
