"""Network queries of a frame's rays, beside eager float32 and the exact answer of Embree.

The ceiling is the rate of the layers' matrix products in our number format. On two threads each
answers half of the frame, as two evaluation jobs side by side do.
"""

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import torch
from frame_query import FrameQuery
from measurement import Row, median_seconds
from torch import Tensor

from neural_shadows.networks.compute import choose_device, choose_dtype
from neural_shadows.networks.object_space.frequency_network import FrequencyNetwork
from neural_shadows.networks.object_space.shadow_network import QUERY_CHUNKS, ShadowNetwork
from neural_shadows.networks.object_space.shadow_query import on_device, sphere_rays
from neural_shadows.networks.weight_file import load_network
from neural_shadows.rendering.exact_shadow import exact_visibility
from neural_shadows.rendering.gbuffer import GBuffer, render_gbuffer
from neural_shadows.rendering.viewpoints import draw_viewpoints
from neural_shadows.scenes.scene import Scene, open_scene

WIDTHS = (256, 128, 64)
SCENE = {"up": "y", "ground": True, "light": {"domain": "sphere", "min_elevation_deg": 20}}
WIDTH, HEIGHT, SEED = 1200, 800, 2026


def rows(mesh_ply: Path, weights: Sequence[Path], quick: bool) -> list[Row]:
    """Rates of untrained networks of the thesis's widths, and of trained ones of any kind.

    Args:
        weights: of trained networks, beside which the 256-wide one stands as a peer.
    """
    torch.set_num_threads(1)
    scene = open_scene(mesh_ply, **SCENE)
    (view,) = draw_viewpoints(scene, ["surface"], [0], WIDTH / HEIGHT, SEED)
    frame = render_gbuffer(scene, view, WIDTH, HEIGHT)
    cpu = choose_device("cpu")
    p, light = on_device(frame.p, view.light, cpu)
    origins, d = sphere_rays(p, light).origins, -light
    dtype = choose_dtype("auto", cpu)
    found = _width_rows(scene, frame, origins, d, dtype, 2 if quick else 5)
    found += _trained_rows(weights, origins, d, dtype, 2 if quick else 5)
    if torch.cuda.is_available():
        found += _cuda_rows(frame, 5 if quick else 50)
    return found


def thesis_network(width: int) -> FrequencyNetwork:
    """An untrained network: the rate does not depend on its weights."""
    network = FrequencyNetwork(frequencies=10, width=width, hidden_layers=8)
    network.initialise(0)
    return network


def _two_halves(network: ShadowNetwork, origins: Tensor, d: Tensor, dtype) -> Callable[[], object]:
    halves = origins.chunk(2)
    pool = ThreadPoolExecutor(2, initializer=torch.set_num_threads, initargs=(1,))
    return lambda: list(pool.map(lambda half: network.depths(half, d, dtype), halves))


def _products(network: FrequencyNetwork, dtype, rays: int) -> Callable[[], object]:
    """The matrix products of a query, forward alone."""
    rows = QUERY_CHUNKS["cpu"]
    layers = [
        (torch.randn(rows, weight.shape[1]).to(dtype), weight.detach().to(dtype).t())
        for weight in network.layers
    ]

    def products() -> None:
        for _ in range(rays // rows):
            for x, weight in layers:
                torch.mm(x, weight)

    return products


def _width_rows(
    scene: Scene, frame: GBuffer, origins: Tensor, d: Tensor, dtype, rounds: int
) -> list[Row]:
    found, count = [], len(origins)
    for width in WIDTHS:
        network = thesis_network(width)

        def eager(network=network) -> None:
            with torch.inference_mode():
                network(origins, d.expand(count, 3), torch.float32)

        works = {
            "ours": lambda network=network: network.depths(origins, d, dtype),
            "halves": _two_halves(network, origins, d, dtype),
            "eager float32, whole frame": eager,
            "Embree's occlusion rays": lambda: exact_visibility(scene.tracer, frame),
            "products": _products(network, dtype, count),
        }
        seconds = median_seconds(works, rounds)
        stage = f"query, width {width}, {str(dtype).removeprefix('torch.')}"
        asked = {name: count for name in works} | {"Embree's occlusion rays": len(frame.p)}
        rate = {name: asked[name] / seconds[name] for name in works}
        found += [
            Row(stage, "cpu x1", rate["ours"], "rays/s", rate["products"], peer, rate[peer])
            for peer in ("eager float32, whole frame", "Embree's occlusion rays")
        ]
        found.append(Row(stage, "cpu x2", rate["halves"], "rays/s", 2 * rate["products"]))
    return found


def _trained_rows(weights, origins: Tensor, d: Tensor, dtype, rounds: int) -> list[Row]:
    networks = {path.parent.name: load_network(path)[0] for path in weights}
    if not networks:
        return []
    works = {
        name: lambda network=network: network.depths(origins, d, dtype)
        for name, network in {"thesis": thesis_network(256), **networks}.items()
    }
    seconds = median_seconds(works, rounds)
    rate = {name: len(origins) / value for name, value in seconds.items()}
    peer = "the thesis's network, width 256"
    return [
        Row(f"query, {name}", "cpu x1", rate[name], "rays/s", peer=peer, peer_rate=rate["thesis"])
        for name in networks
    ]


def _cuda_rows(gbuffer: GBuffer, rounds: int):
    """Whole frames from a depth buffer to a mask, all on the GPU."""
    cuda = choose_device("cuda")
    dtype = choose_dtype("auto", cuda)
    query = FrameQuery(gbuffer, cuda)

    def frame(network: ShadowNetwork) -> Callable[[], object]:
        def whole() -> None:
            query.mask(network, dtype)
            torch.cuda.synchronize()

        return whole

    works = {str(width): frame(thesis_network(width).to(cuda)) for width in WIDTHS}
    seconds = median_seconds(works, rounds)
    return [
        Row(
            f"frame from depth buffer to mask, width {width}",
            torch.cuda.get_device_name(),
            1000 * seconds[str(width)],
            "ms a frame",
        )
        for width in WIDTHS
    ]
