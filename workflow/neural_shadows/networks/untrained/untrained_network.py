"""What is common to the rivals of the networks."""

import torch

from neural_shadows.networks.object_space.shadow_network import ShadowNetwork


class UntrainedNetwork(ShadowNetwork):
    """Answers of a mesh's own, without weights; on the CPU."""

    on_gpu = False
    exportable = False

    def initialise(self, seed: int) -> None:
        """There is nothing to set."""

    @property
    def device(self) -> torch.device:
        return torch.device("cpu")
