"""What a network is counted to have and to do, by its modules."""

import torch
from torch import nn


def counted(network, channels, size=64):
    """Weights without biases of a network's parameters, and multiply-adds a pixel by hooks."""
    done = []

    def hook(layer, inputs, output):
        x = inputs[0] if isinstance(layer, nn.ConvTranspose2d) else output
        done.append(layer.weight.numel() * x[0, 0].numel())

    for layer in network.modules():
        if isinstance(layer, nn.Conv2d | nn.ConvTranspose2d):
            layer.register_forward_hook(hook)
    with torch.inference_mode():
        network(torch.zeros(1, channels, size, size))
    weights = sum(one.numel() for one in network.parameters() if one.ndim == 4)
    return weights, sum(done) / size**2
