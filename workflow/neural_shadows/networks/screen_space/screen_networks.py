"""Networks that answer whole frames: made from settings, written, read."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import torch

from neural_shadows.errors import InputError
from neural_shadows.networks.screen_space.exponent_unet import ExponentUnet
from neural_shadows.networks.screen_space.kernel_unet import KernelUnet
from neural_shadows.networks.screen_space.kernel_widths import KERNEL_FORMS
from neural_shadows.networks.screen_space.shadow_unet import ShadowUnet
from neural_shadows.networks.weight_file import load_tensors, save_tensors

STORED = torch.float16

ScreenNetwork = ShadowUnet | KernelUnet


def make_screen_network(settings: Mapping[str, Any]) -> ScreenNetwork:
    """A network from an entry of the config's `screen_networks`: the arguments of `KernelUnet` for its
    forms, of `ShadowUnet` for all others, or by their `answer` of `ExponentUnet`.

    Raises:
        KeyError, TypeError, ValueError: an argument is missing, unknown or wrong.
    """
    told = dict(settings)
    answers = {"visibility": ShadowUnet, "exponent": ExponentUnet}[told.pop("answer", "visibility")]
    made = KernelUnet if told["form"] in KERNEL_FORMS else answers
    return made(**told)


def save_screen_network(path: Path, network: ScreenNetwork, header: Mapping[str, Any]) -> None:
    """Write a network's weights in 16 bits; `header["network"]` must hold its settings."""
    tensors = {name: one.to(STORED) for name, one in network.state_dict().items()}
    save_tensors(path, tensors, header)


def load_screen_network(path: Path) -> tuple[ScreenNetwork, dict[str, Any]]:
    """Read a network, in float32, and the header that it was saved with.

    Raises:
        InputError: the file is damaged, or its weights are not of the widths in its header.
    """
    tensors, header = load_tensors(path)
    try:
        network = make_screen_network(header["network"])
        network.load_state_dict({name: one.float() for name, one in tensors.items()})
    except (KeyError, TypeError, ValueError, RuntimeError) as error:
        reason = " ".join(str(error).split())[:200]
        raise InputError(
            f"{path}: its weights do not fit the settings in its header ({reason}); delete it and "
            "train again"
        ) from error
    return network, header
