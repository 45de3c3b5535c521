"""What every shadow network can do, whatever it is made of [3.1, 3.3]."""

from abc import ABC, abstractmethod
from collections.abc import Callable
from pathlib import Path
from typing import ClassVar, NamedTuple

import torch
from torch import Tensor, nn

from neural_shadows.networks.object_space.dead_zone_loss import DeadZone
from neural_shadows.networks.object_space.sphere_rays import SphereRays

# Rays per forward pass: on a CPU one layer's activations of 256 × bfloat16 are then 2 MiB and
# stay in the cache; on a GPU a whole frame goes at once.
QUERY_CHUNKS = {"cpu": 4096, "cuda": 1 << 20}


class LabelledBatch(NamedTuple):
    """Rays with their labels, all float32 and on one device, in normalised space."""

    origins: Tensor  # (n, 3), on the unit sphere
    directions: Tensor  # (n, 3), unit, pointing inward
    t_lb: Tensor  # (n,)
    t_ub: Tensor  # (n,), may be ∞


def chords(origins: Tensor, directions: Tensor) -> Tensor:
    """ℓ = −2 o·d of each ray, the length of its chord of the unit sphere: (n,)."""
    return -2 * (origins * directions).sum(1)


def hits(batch: LabelledBatch) -> Tensor:
    """Which rays meet the object, (n,) bool: of a miss t_lb is ℓ itself, up to rounding."""
    return batch.t_lb < chords(batch.origins, batch.directions) - 1e-5


class ShadowNetwork(nn.Module, ABC):
    """A function t_pred(o, d), of trained weights or not: behind that depth, all is in shadow.

    A kind of network is a file of `object_space/kinds`, with the settings that are its class's
    arguments, and that class, a subclass, in a module of its own.
    """

    # Rays per forward and backward pass on a CPU, at most: at 256 wide one layer's activations
    # are then 1 MiB and stay in a core's cache.
    training_chunk: ClassVar[int] = 2048
    query_chunks: ClassVar[dict[str, int]] = QUERY_CHUNKS
    # Whether the losses have the same shapes whatever the batch, draw nothing, and read nothing
    # back from a GPU, so that a GPU can record a training step and repeat it.
    recordable: ClassVar[bool] = False
    # Whether it computes on a GPU where there is one.
    on_gpu: ClassVar[bool] = True
    # Whether it can be written as ONNX.
    exportable: ClassVar[bool] = True
    # By how much of a cell the surface of an untrained distance grid may be moved out before it is
    # asked; held-out views say which is best. Where there is no such surface, not at all.
    pushes: tuple[float, ...] = (0.0,)
    push: float = 0.0  # one of `pushes`

    def prepare(self, mesh_ply: Path) -> None:
        """Lay out what depends on the prepared mesh and is not trained; called before training."""
        raise NotImplementedError(f"{type(self).__name__} needs no mesh")

    @abstractmethod
    def initialise(self, seed: int) -> None:
        """Set the weights that a training starts from."""

    @abstractmethod
    def forward(self, origins: Tensor, directions: Tensor, dtype: torch.dtype) -> Tensor:
        """Predicted shadow depth t_pred, (n,) float32, in units of the sphere's radius.

        Args:
            origins: (n, 3) float32, on the unit sphere.
            directions: (n, 3) float32, unit, pointing inward.
            dtype: of the matrix products, float32 or bfloat16.
        """

    def losses(
        self,
        batch: LabelledBatch,
        dead_zone: DeadZone,
        dtype: torch.dtype,
        generator: torch.Generator | None,
    ) -> tuple[Tensor, Tensor]:
        """Losses whose sum is the batch's, and outputs that differ as long as the network lives.

        Here a loss for each ray (n,); a kind may leave out rays that need no network, or judge
        points on them, drawn by a generator on the batch's device (None if it is `recordable`).
        """
        t = self(batch.origins, batch.directions, dtype)
        return dead_zone(t, batch.t_lb, batch.t_ub), t

    @property
    def device(self) -> torch.device:
        """Where its weights are."""
        return next(self.parameters()).device

    def depths(self, origins: Tensor, d: Tensor, dtype: torch.dtype) -> Tensor:
        """t_pred (k,) float32 of rays from entry points (k, 3) along one d (3,); see `forward`."""
        with torch.inference_mode():
            chunks = origins.split(self.query_chunks[self.device.type])
            return torch.cat([self(chunk, d.expand(len(chunk), 3), dtype) for chunk in chunks])

    def lit(
        self, rays: SphereRays, d: Tensor, dtype: torch.dtype, t_pred: Tensor | None = None
    ) -> Callable[[float], Tensor]:
        """Which points at the ends of rays along one d (3,) are lit, of any depth bias [3.6.2].

        shadowed ⟺ min(s, ℓ) > t_pred(o, d) + depth_bias. The clamp of s to the chord ℓ is
        essential: a ray that misses the object is only ever trained to t ≥ ℓ, so that without
        it every receiver behind the sphere would be in shadow.

        Args:
            t_pred: what `depths` gives of these rays, where that is known already.

        Returns:
            a function of the depth bias, in sphere radii, that gives (k,) bool.
        """
        if t_pred is None:
            t_pred = self.depths(rays.origins, d, dtype)
        s = torch.minimum(rays.s, rays.chord)
        return lambda depth_bias: s <= t_pred + depth_bias

    def resident_bytes(self) -> int:
        """Memory that a query on its present device reads; here all weights and buffers."""
        held = (*self.parameters(), *self.buffers())
        return sum(tensor.numel() * tensor.element_size() for tensor in held)

    def parameter_count(self) -> int:
        """Number of trained weights: 556,800 for the thesis's network at width 256 [4.4.2]."""
        return sum(weight.numel() for weight in self.parameters())

    def stored(self) -> dict[str, Tensor]:
        """The tensors of a weight file; a network made from them answers as the file will."""
        return dict(self.state_dict())

    def restore(self, tensors: dict[str, Tensor]) -> None:
        """Take the tensors that `stored` gave; RuntimeError, KeyError or ValueError at others."""
        self.load_state_dict(tensors)
