"""Hard-shadow methods: networks, rays, and `hard_methods`.

A shadow method takes a frame's G-buffer and returns a function of the depth bias, so that it runs
once for all biases. The bias, in sphere radii, is added to the height or depth that a method
compares; others ignore it.
"""

from pathlib import Path
from typing import TYPE_CHECKING

from neural_shadows.evaluation.hard_method import OfBias, ShadowMethod, whatever_bias
from neural_shadows.evaluation.method_names import METHODS, RAY_TRACED, family_and_size
from neural_shadows.files.whole_files import read_json
from neural_shadows.rendering.exact_shadow import exact_visibility
from neural_shadows.rendering.gbuffer import GBuffer
from neural_shadows.scenes.scene import Scene

if TYPE_CHECKING:  # torch takes seconds to import: only with a network
    import torch

    from neural_shadows.networks.object_space.shadow_network import ShadowNetwork


def classic_method(method: str, scene: Scene, *, whole_map: bool = False) -> ShadowMethod:
    """A method without a network: `ray_traced`, or of `hard_methods`.

    Args:
        method: the key, without a bias.
        whole_map: rasterise each texel of a shadow map, as a renderer does; else only the
            texels of receivers are traced, in a fraction of the time at 2048² and with the same
            values but for rounding.
    """
    if method == RAY_TRACED:
        return lambda frame: whatever_bias(exact_visibility(scene.tracer, frame))
    family, size = family_and_size(method)
    return METHODS[family].of_scene(scene, size, whole_map)


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
    """A network on its device, with its number format.

    float32 for a network that is always on the CPU, as it multiplies no matrices.

    Args:
        device: `auto`, `cpu` or `cuda`; unused by a network that is always on the CPU.
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
    """Set a network's push from held-out views; return its bias.

    Raises:
        InputError: the file cannot be read.
    """
    chosen = read_json(depth_bias_json)
    network.push = chosen["push"]
    return chosen["depth_bias"]
