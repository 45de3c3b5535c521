"""Common interface of shadow networks [3.1, 3.3]."""

from abc import ABC, abstractmethod
from collections.abc import Callable
from pathlib import Path
from typing import ClassVar, NamedTuple

import torch
from torch import Tensor, nn

from neural_shadows.networks.object_space.dead_zone_loss import DeadZone
from neural_shadows.networks.object_space.sphere_rays import SphereRays, sphere_rays

# Rays per forward pass. On a CPU one layer's activations of 256 × bfloat16 then take 2 MiB and stay
# in the cache; on a GPU a whole frame goes at once.
QUERY_CHUNKS = {"cpu": 4096, "cuda": 1 << 20}


class LabelledBatch(NamedTuple):
    """Rays with labels in normalised space, float32, on one device."""

    origins: Tensor  # (n, 3), on the unit sphere
    directions: Tensor  # (n, 3), unit, pointing inward
    t_lb: Tensor  # (n,)
    t_ub: Tensor  # (n,), may be ∞


def chords(origins: Tensor, directions: Tensor) -> Tensor:
    """Chord length of each ray, ℓ = −2 o·d: (n,)."""
    return -2 * (origins * directions).sum(1)


def hits(batch: LabelledBatch) -> Tensor:
    """Mask (n,) bool of rays hitting the object; misses have t_lb = ℓ, up to rounding."""
    return batch.t_lb < chords(batch.origins, batch.directions) - 1e-5


class ShadowNetwork(nn.Module, ABC):
    """Function t_pred(o, d), trained or not: all behind it is shadowed.

    A kind of network is a file of `object_space/kinds` with its settings, which are its class's
    arguments, and that class, a subclass, in a module of its own.
    """

    # Most rays per forward and backward pass on a CPU: at width 256 one layer's activations then
    # take 1 MiB and stay in a core's cache.
    training_chunk: ClassVar[int] = 2048
    query_chunks: ClassVar[dict[str, int]] = QUERY_CHUNKS
    # Losses of constant shapes, without random numbers or reads from a GPU, so that a GPU can
    # record and replay a training step.
    recordable: ClassVar[bool] = False
    # Uses a GPU where there is one.
    on_gpu: ClassVar[bool] = True
    # Exportable as ONNX.
    exportable: ClassVar[bool] = True
    # Candidate offsets, in cells, of an untrained distance grid's surface outwards; chosen on
    # validation views. Other networks have none.
    pushes: tuple[float, ...] = (0.0,)
    push: float = 0.0  # one of `pushes`

    def prepare(self, mesh_ply: Path) -> None:
        """Lay out everything untrained by the prepared mesh, before training."""
        raise NotImplementedError(f"{type(self).__name__} needs no mesh")

    @abstractmethod
    def initialise(self, seed: int) -> None:
        """Set the initial weights."""

    @abstractmethod
    def forward(self, origins: Tensor, directions: Tensor, dtype: torch.dtype) -> Tensor:
        """Predict shadow depths t_pred, (n,) float32, in sphere radii.

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
        """Loss terms (n,) of a batch, and outputs for detecting divergence.

        Their sum is the batch's loss. Here one term a ray; a kind may leave out rays that need no
        network, or draw points on rays by a generator on the batch's device (None if `recordable`).
        """
        t = self(batch.origins, batch.directions, dtype)
        return dead_zone(t, batch.t_lb, batch.t_ub), t

    @property
    def device(self) -> torch.device:
        """Device of the weights."""
        return next(self.parameters()).device

    def depths(self, origins: Tensor, d: Tensor, dtype: torch.dtype) -> Tensor:
        """Predict t_pred (k,) float32 along one d (3,); see `forward`."""
        with torch.inference_mode():
            chunks = origins.split(self.query_chunks[self.device.type])
            return torch.cat([self(chunk, d.expand(len(chunk), 3), dtype) for chunk in chunks])

    def lit(self, rays: SphereRays, d: Tensor, dtype: torch.dtype) -> Callable[[float], Tensor]:
        """Test points at rays' ends along d (3,) by depth bias [3.6.2].

        shadowed ⟺ min(s, ℓ) > t_pred(o, d) + depth_bias. The clamp of s to the chord ℓ is
        essential: misses are only ever trained to t ≥ ℓ, so that without it every receiver behind
        the sphere would be in shadow.

        Returns:
            a function from the depth bias, in sphere radii, to (k,) bool.
        """
        t_pred = self.depths(rays.origins, d, dtype)
        s = torch.minimum(rays.s, rays.chord)
        return lambda depth_bias: s <= t_pred + depth_bias

    def points_lit(self, p: Tensor, light: Tensor, dtype: torch.dtype) -> Callable[[float], Tensor]:
        """Evaluate once for any number of depth biases [3.6.2]; see `lit`.

        Args:
            p, light: as for `sphere_rays`, in normalised space and on the network's device.

        Returns:
            a function from the depth bias, in sphere radii, to (m,) bool: lit points. Culled ones
            are lit.
        """
        rays = sphere_rays(p, light)
        rays_lit = self.lit(rays, -light, dtype)

        def lit(depth_bias: float) -> Tensor:
            points = torch.ones(len(p), dtype=torch.bool, device=p.device)
            return points.scatter_(0, rays.index, rays_lit(depth_bias))

        return lit

    def resident_bytes(self) -> int:
        """Memory read by a query on the present device: all weights and buffers."""
        tensors = (*self.parameters(), *self.buffers())
        return sum(tensor.numel() * tensor.element_size() for tensor in tensors)

    def parameter_count(self) -> int:
        """Number of trained weights: 556,800 for width 256 [4.4.2]."""
        return sum(weight.numel() for weight in self.parameters())

    def stored(self) -> dict[str, Tensor]:
        """Tensors of the weight file."""
        return dict(self.state_dict())

    def restore(self, tensors: dict[str, Tensor]) -> None:
        """Load the tensors of `stored`; RuntimeError, KeyError or ValueError for others."""
        self.load_state_dict(tensors)
