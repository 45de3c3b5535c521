"""Every way of answering which points of a frame the light reaches."""

import time
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import numpy as np
import torch
from torch import Tensor

from neural_shadows.evaluation.method_names import RAY_TRACED, shadow_map_key
from neural_shadows.meshes.prepared_mesh import PreparedMesh
from neural_shadows.networks.compute import choose_device, choose_dtype
from neural_shadows.networks.object_space.shadow_network import ShadowNetwork
from neural_shadows.networks.object_space.shadow_query import network_lit, on_device
from neural_shadows.networks.weight_file import load_network
from neural_shadows.rendering.gbuffer import ShadingPoints
from neural_shadows.rendering.shading import reference_visibility
from neural_shadows.scenes.tracing import Tracer
from neural_shadows.shadow_maps.shadow_map import (
    depth_test,
    receivers_of,
    shadow_map_frame,
    shadow_map_lit,
    texel_heights,
    texels_of,
)

REFERENCE_MAP_RESOLUTION = 32768  # the thesis's reference [4.1]

# Lit (m,) bool of a frame's facing points, by method.
Visibilities = Callable[[ShadingPoints], dict[str, np.ndarray]]


def reference_of(
    mesh: PreparedMesh, tracer: Tracer, kind: str
) -> Callable[[ShadingPoints], np.ndarray]:
    """The reference's lit (m,): `exact`, or the thesis's 32768² `shadow_map`."""
    if kind == "exact":
        return lambda points: reference_visibility(tracer, points)
    return lambda points: map_visibilities(mesh, tracer, [REFERENCE_MAP_RESOLUTION])(points)[
        shadow_map_key(REFERENCE_MAP_RESOLUTION)
    ]


def map_visibilities(
    mesh: PreparedMesh, tracer: Tracer, resolutions: Sequence[int]
) -> Visibilities:
    """Shadow maps by key `shadow_map_N`; a frame's points are projected once for all of them."""

    def visibilities(points: ShadingPoints) -> dict[str, np.ndarray]:
        receivers = receivers_of(shadow_map_frame(mesh.vertices, points.light), points)
        return {
            shadow_map_key(resolution): shadow_map_lit(tracer, receivers, resolution)
            for resolution in resolutions
        }

    return visibilities


def network_visibilities(
    weights: Mapping[str, Path], depth_biases: Mapping[str, float], *, device: str, precision: str
) -> Visibilities:
    """Trained networks, and the depth bias of each, by the method's key."""
    chosen = choose_device(device)
    dtype = choose_dtype(precision, chosen)
    networks = {name: load_network(path)[0].to(chosen) for name, path in weights.items()}

    def visibilities(points: ShadingPoints) -> dict[str, np.ndarray]:
        p, light = on_device(points.p, points.light, chosen)
        return {
            name: network_lit(network, p, light, dtype=dtype, depth_bias=depth_biases[name])
            .cpu()
            .numpy()
            for name, network in networks.items()
        }

    return visibilities


# Lit (m,) bool of a frame's facing points.
ShadowPass = Callable[[ShadingPoints], np.ndarray]


def whole_map_lit(
    mesh: PreparedMesh, tracer: Tracer, points: ShadingPoints, resolution: int
) -> np.ndarray:
    """Render a shadow map whole, as a renderer does before it knows its receivers, and look it up.

    Returns lit (m,) bool, the same as `shadow_map_lit`, which traces only the texels in use.
    """
    frame = shadow_map_frame(mesh.vertices, points.light)
    heights = texel_heights(tracer, frame, resolution, np.arange(resolution**2))
    receivers = receivers_of(frame, points)
    return depth_test(receivers, heights[texels_of(receivers, resolution)], resolution)


class StopwatchNetwork:
    """A network whose last query was timed: how many rays, in how many seconds."""

    def __init__(self, network: ShadowNetwork):
        self.network = network
        self.rays, self.seconds = 0, 0.0

    @property
    def device(self) -> torch.device:
        """See `DepthQuery.device`."""
        return self.network.device

    def depths(self, origins: Tensor, d: Tensor, dtype: torch.dtype) -> Tensor:
        """See `ShadowNetwork.depths`; a GPU is waited for."""
        started = time.perf_counter()
        depths = self.network.depths(origins, d, dtype)
        if self.device.type == "cuda":
            torch.cuda.synchronize()
        self.rays, self.seconds = len(origins), time.perf_counter() - started
        return depths


def shadow_passes(
    mesh: PreparedMesh,
    tracer: Tracer,
    networks: Mapping[str, StopwatchNetwork],
    shadow_maps: Sequence[int],
    dtype: torch.dtype,
) -> dict[str, ShadowPass]:
    """The shadow pass of each method: `ray_traced`, `shadow_map_N`, then networks by name."""
    passes: dict[str, ShadowPass] = {
        RAY_TRACED: lambda points: reference_visibility(tracer, points)
    }
    for resolution in shadow_maps:
        passes[shadow_map_key(resolution)] = lambda points, resolution=resolution: whole_map_lit(
            mesh, tracer, points, resolution
        )
    for name, network in networks.items():
        passes[name] = lambda points, network=network: (
            network_lit(network, *on_device(points.p, points.light, network.device), dtype=dtype)
            .cpu()
            .numpy()
        )
    return passes
