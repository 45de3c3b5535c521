"""Networks on rays as methods of views under a sun."""

from pathlib import Path
from typing import TYPE_CHECKING

from neural_shadows.evaluation.frame import constants_of
from neural_shadows.evaluation.method import BIASES, Method, OfBias, ShadowMethod
from neural_shadows.rendering.gbuffer import GBuffer

if TYPE_CHECKING:  # torch takes seconds to import: only with a network
    import torch

    from neural_shadows.networks.object_space.shadow_network import ShadowNetwork


def network_method(network: "ShadowNetwork", dtype: "torch.dtype") -> ShadowMethod:
    """A network, trained or not.

    Args:
        dtype: of the matrix products.
    """
    from neural_shadows.networks.object_space.shadow_query import on_device

    def answer(frame: GBuffer) -> OfBias:
        p, light = on_device(frame.p, frame.view.light, network.device)
        lit = network.points_lit(p, light, dtype)
        return lambda depth_bias: frame.visibility(lit(depth_bias).cpu().numpy())

    return answer


def ray_method(weights: Path, device: str, threads: int, precision: str) -> Method:
    """The method of a file of weights, with its constants."""
    network, dtype = open_network(weights, device, threads, precision)
    method = network_method(network, dtype)

    def sun(frame: GBuffer, scene: None, *, push: float = network.push) -> OfBias:
        network.push = push
        return method(frame)

    return Method(sun=sun, constants={"push": network.pushes, "depth_bias": BIASES}, joint=True)


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


def take_constants(network: "ShadowNetwork", constants_json: Path) -> float:
    """Set a network's tuned push; return its depth bias.

    Raises:
        InputError: the file cannot be read.
    """
    (chosen,) = constants_of(constants_json)
    network.push = chosen["push"]
    return chosen["depth_bias"]
