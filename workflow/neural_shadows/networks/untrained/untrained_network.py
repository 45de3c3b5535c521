"""Common base of the untrained baselines."""

import torch

from neural_shadows.networks.object_space.shadow_network import ShadowNetwork


class UntrainedNetwork(ShadowNetwork):
    """Shadow network without weights, from the mesh; on the CPU."""

    on_gpu = False
    exportable = False

    def initialise(self, seed: int) -> None:
        """Do nothing."""

    @property
    def device(self) -> torch.device:
        return torch.device("cpu")
