"""Every way of answering which points of a frame the light reaches.

A shadow method is asked of a frame's G-buffer, and gives a function of the depth bias: so it is
asked once for all biases. The bias, in sphere radii, is added to the height or depth that a
method compares; what compares none ignores it. The function answers the visibility of the light at
the frame's n surface points, (n,) float32 in [0, 1]; 0 where a surface is turned from the light.
"""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from neural_shadows.evaluation.method_names import (
    NO_SHADOW,
    RAY_TRACED,
    family_of,
    is_null,
    resolution_of,
    shadow_map_key,
)
from neural_shadows.files.whole_files import read_json
from neural_shadows.rendering.exact_shadow import exact_visibility
from neural_shadows.rendering.gbuffer import GBuffer
from neural_shadows.scenes.scene import Scene
from neural_shadows.shadow_maps.depth_test import HeightsAt, depth_test
from neural_shadows.shadow_maps.shadow_map import ShadowMapSquare, receivers_of, shadow_map_square
from neural_shadows.shadow_maps.trace import looked_up_heights
from neural_shadows.shadow_maps.unorm16 import from_unorm16, to_unorm16

if TYPE_CHECKING:  # torch takes seconds to import, which jobs without a network need not wait for
    import torch

    from neural_shadows.networks.object_space.shadow_network import ShadowNetwork

OfBias = Callable[[float], np.ndarray]
ShadowMethod = Callable[[GBuffer], OfBias]

# By the config's word: shadow rays, or the thesis's map of 32768² texels [4.1].
REFERENCES = {"exact": RAY_TRACED, "shadow_map": shadow_map_key(32768)}


def classic_method(method: str, scene: Scene, *, whole_map: bool = False) -> ShadowMethod:
    """The method of a key that needs no network: `ray_traced`, a null predictor or a map.

    Args:
        method: the key, without a bias.
        whole_map: rasterise each texel of a shadow map, as a renderer does before it knows its
            receivers; else those alone are traced that some receiver looks up, which takes a
            fraction of the time at 2048² and gives the same values but for rounding.
    """
    if method == RAY_TRACED:
        return lambda frame: _whatever_bias(exact_visibility(scene.tracer, frame))
    if is_null(method):
        lit = float(method == NO_SHADOW)
        return lambda frame: _whatever_bias(frame.visibility(np.full(len(frame.p), lit)))
    (mesh,) = scene.objects
    resolution, family = resolution_of(method), family_of(method)

    def answer(frame: GBuffer) -> OfBias:
        square = shadow_map_square(mesh.vertices, frame.view.light)
        heights_at = _heights_at(scene, square, resolution, whole_map, family.sixteen_bit)
        lit = depth_test(receivers_of(square, frame), resolution, heights_at, pcf=family.pcf)
        return lambda depth_bias: frame.visibility(lit(depth_bias))

    return answer


def _whatever_bias(visibility: np.ndarray) -> OfBias:
    return lambda depth_bias: visibility


def _heights_at(
    scene: Scene, square: ShadowMapSquare, resolution: int, whole_map: bool, sixteen_bit: bool
) -> HeightsAt:
    if not whole_map:

        def heights_at(texels: np.ndarray) -> np.ndarray:
            heights = looked_up_heights(scene.tracer, square, resolution, texels)
            return from_unorm16(to_unorm16(heights, square), square) if sixteen_bit else heights

        return heights_at
    # Here and not above: numba takes a second to import.
    from neural_shadows.shadow_maps.rasterise import rasterised_heights

    (mesh,) = scene.objects
    heights = rasterised_heights(mesh.vertices, mesh.faces, square, resolution).ravel()
    if sixteen_bit:
        codes = to_unorm16(heights, square)
        return lambda texels: from_unorm16(codes[texels], square)
    return lambda texels: heights[texels]


def network_method(network: "ShadowNetwork", dtype: "torch.dtype") -> ShadowMethod:
    """A network, trained or not.

    Args:
        dtype: of the matrix products.
    """
    from neural_shadows.networks.object_space.shadow_query import network_lit, on_device

    def answer(frame: GBuffer) -> OfBias:
        p, light = on_device(frame.p, frame.view.light, network.device)
        lit = network_lit(network, p, light, dtype=dtype)
        return lambda depth_bias: frame.visibility(lit(depth_bias).cpu().numpy())

    return answer


def open_network(
    weights: Path, device: str, threads: int, precision: str = "auto"
) -> tuple["ShadowNetwork", "torch.dtype"]:
    """A network on its device, and the number format of its products there; float32 of one that is
    always on the CPU, as it multiplies no matrices.

    Args:
        device: `auto`, `cpu` or `cuda`; not asked of a network that is always on the CPU.
        threads: of PyTorch on the CPU, from now on.
        precision: of its products, see `choose_dtype`.

    Raises:
        InputError: the file cannot be read, there is no such device, or it lacks the format.
    """
    import torch

    from neural_shadows.networks.compute import choose_device, choose_dtype
    from neural_shadows.networks.weight_file import load_network

    torch.set_num_threads(threads)
    network, _ = load_network(weights)
    if not network.on_gpu:
        return network, torch.float32
    chosen = choose_device(device)
    return network.to(chosen), choose_dtype(precision, chosen)


def take_found(network: "ShadowNetwork", depth_bias_json: Path) -> float:
    """Give a network the push that was found for it on held-out views; the depth bias with it.

    Raises:
        InputError: the file cannot be read.
    """
    found = read_json(depth_bias_json)
    network.push = found["push"]
    return found["depth_bias"]
