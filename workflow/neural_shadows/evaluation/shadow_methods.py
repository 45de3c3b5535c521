"""Every way of answering which points of a frame the light reaches.

A shadow method is a function of a frame's G-buffer that answers the visibility of the light at
its n surface points, (n,) float32 in [0, 1]; 0 where a surface is turned from the light.
"""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from neural_shadows.evaluation.method_names import RAY_TRACED, resolution_of, shadow_map_key
from neural_shadows.rendering.exact_shadow import exact_visibility
from neural_shadows.rendering.gbuffer import GBuffer
from neural_shadows.scenes.scene import Scene
from neural_shadows.shadow_maps.shadow_map import receivers_of, shadow_map_lit, shadow_map_square

if TYPE_CHECKING:  # torch takes seconds to import, which jobs without a network need not wait for
    import torch

    from neural_shadows.networks.object_space.shadow_network import ShadowNetwork

ShadowMethod = Callable[[GBuffer], np.ndarray]

# By the config's word: shadow rays, or the thesis's map of 32768² texels [4.1].
REFERENCES = {"exact": RAY_TRACED, "shadow_map": shadow_map_key(32768)}


def traced_method(method: str, scene: Scene, *, whole_map: bool = False) -> ShadowMethod:
    """The method of a key that needs no network: `ray_traced` or `shadow_map_N`.

    Args:
        whole_map: whether each texel of a shadow map is rendered, see `shadow_map_lit`.
    """
    if method == RAY_TRACED:
        return lambda frame: exact_visibility(scene.tracer, frame)
    (mesh,) = scene.objects
    resolution = resolution_of(method)

    def visibility(frame: GBuffer) -> np.ndarray:
        receivers = receivers_of(shadow_map_square(mesh.vertices, frame.view.light), frame)
        return frame.visibility(shadow_map_lit(scene.tracer, receivers, resolution, whole_map))

    return visibility


def network_method(
    network: "ShadowNetwork", dtype: "torch.dtype", depth_bias: float = 0.0
) -> ShadowMethod:
    """A trained network.

    Args:
        dtype: of the matrix products.
        depth_bias: of the depth test, in sphere radii.
    """
    from neural_shadows.networks.object_space.shadow_query import network_lit, on_device

    def visibility(frame: GBuffer) -> np.ndarray:
        p, light = on_device(frame.p, frame.view.light, network.device)
        lit = network_lit(network, p, light, dtype=dtype, depth_bias=depth_bias)
        return frame.visibility(lit.cpu().numpy())

    return visibility


def open_network(weights: Path, device: str, threads: int) -> tuple["ShadowNetwork", "torch.dtype"]:
    """A trained network on its device, and the number format of its products there.

    Args:
        device: `auto`, `cpu` or `cuda`.
        threads: of PyTorch on the CPU, from now on.

    Raises:
        InputError: the file cannot be read, or there is no such device.
    """
    import torch

    from neural_shadows.networks.compute import choose_device, choose_dtype
    from neural_shadows.networks.weight_file import load_network

    torch.set_num_threads(threads)
    chosen = choose_device(device)
    return load_network(weights)[0].to(chosen), choose_dtype("auto", chosen)
