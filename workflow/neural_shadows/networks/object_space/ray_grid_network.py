"""Ray grid: a small network over grid features along a ray.

Besides (o, d) its inputs are the features of dense grids at K points, evenly spread over the ray's
chord.
"""

import torch
from torch import Tensor, nn

from neural_shadows.networks.object_space.dead_zone_loss import DeadZone
from neural_shadows.networks.object_space.shadow_network import (
    LabelledBatch,
    ShadowNetwork,
    chords,
    hits,
)
from neural_shadows.networks.quantisation import quantise, restore_values
from neural_shadows.representations.depths import LIT

# Weight of the cross-entropy of hit or miss beside the dead-zone loss, which is smaller (in sphere
# radii). Not tuned.
CONFIDENCE_WEIGHT = 0.1


class FeatureGrid(nn.Module):
    """Trained features on a cubic grid over [−1, 1]³, interpolated trilinearly.

    Args:
        resolution: vertices along an axis.
        channels: features of a vertex.
        entries: vertices with features of their own.
    """

    def __init__(self, resolution: int, channels: int, entries: int | None = None):
        super().__init__()
        self.resolution, self.channels = resolution, channels
        self.values = nn.Parameter(torch.empty(entries or resolution**3, channels))
        corners = torch.cartesian_prod(*[torch.arange(2)] * 3)
        self.register_buffer("corners", corners, persistent=False)

    def index(self, vertices: Tensor) -> Tensor:
        """Indices (...) of the features of vertices (..., 3) int64."""
        x, y, z = vertices.unbind(-1)
        return (x * self.resolution + y) * self.resolution + z

    def forward(self, p: Tensor) -> Tensor:
        """Features (n, channels) float32 at points (n, 3) float32; clamped to the cube."""
        u = ((p + 1) * ((self.resolution - 1) / 2)).clamp(0, self.resolution - 1)
        cell = u.floor().clamp(max=self.resolution - 2)
        w = u - cell
        index = self.index(cell.long()[:, None] + self.corners)  # (n, 8)
        # The backward pass of index_select takes half the time of that of values[index].
        features = self.values.index_select(0, index.flatten()).unflatten(0, (-1, 8))
        weights = torch.where(self.corners.bool(), w[:, None], 1 - w[:, None]).prod(-1)
        return (features * weights[:, :, None]).sum(1)


class RayGridNetwork(ShadowNetwork):
    """t_pred(o, d) from the features of points along the ray.

    Args:
        points: K along the ray.
        grids: vertices along an axis of each grid.
        channels: features of each vertex.
        width, hidden_layers: of the network behind; ReLU, with biases.
        head: `depth`, or `depth_confidence`: a second output predicts hit or miss, the depth is
            trained on hits alone, and only confidence > 0.5 casts shadow.
        stored: format in the weight file: `float32`, `float16` or `int8`.
    """

    training_chunk = 4096
    # Bounded by a GPU's memory: marching 128 steps takes some 10 KiB a ray.
    query_chunks = {"cpu": 4096, "cuda": 1 << 15}

    def __init__(
        self,
        *,
        points: int,
        grids: list[int],
        channels: int,
        width: int,
        hidden_layers: int,
        head: str,
        stored: str,
    ):
        super().__init__()
        self.points, self.head, self.storage = points, head, stored
        self.grids = nn.ModuleList(self.feature_grid(n, channels) for n in grids)
        # Features of all points, o, d, and the depths t_a and t_b of their span.
        sizes = [points * channels * len(grids) + 8] + [width] * hidden_layers
        outputs = {"depth": 1, "depth_confidence": 2}[head]
        self.layers = nn.ModuleList(nn.Linear(a, b) for a, b in zip(sizes, sizes[1:]))
        self.output = nn.Linear(width, outputs)
        fractions = (torch.arange(points, dtype=torch.float32) + 0.5) / points
        self.register_buffer("fractions", fractions, persistent=False)

    def feature_grid(self, resolution: int, channels: int) -> FeatureGrid:
        """Build one of the grids."""
        return FeatureGrid(resolution, channels)

    def initialise(self, seed: int) -> None:
        """Nearly zero grids, He initialisation behind them."""
        generator = torch.Generator().manual_seed(seed)
        with torch.no_grad():
            for grid in self.grids:
                grid.values.uniform_(-0.01, 0.01, generator=generator)
            for layer in (*self.layers, self.output):
                nn.init.kaiming_uniform_(layer.weight, nonlinearity="relu", generator=generator)
                layer.bias.zero_()

    def span(self, origins: Tensor, directions: Tensor) -> tuple[Tensor, Tensor, Tensor]:
        """Part of each ray to spread its points over.

        Returns:
            t_a, t_b (n,) float32; (n,) bool: there is something to hit.
        """
        chord = chords(origins, directions)
        return torch.zeros_like(chord), chord, torch.ones_like(chord, dtype=torch.bool)

    def outputs(
        self, origins: Tensor, directions: Tensor, t_a: Tensor, t_b: Tensor, dtype: torch.dtype
    ) -> Tensor:
        """Outputs (n, 1 or 2): depth behind t_a, and the confidence logit."""
        t = t_a[:, None] + self.fractions * (t_b - t_a)[:, None]
        p = (origins[:, None] + t[:, :, None] * directions[:, None]).flatten(0, 1)
        features = [grid(p).view(-1, self.points * grid.channels) for grid in self.grids]
        h = torch.cat([*features, origins, directions, t_a[:, None], t_b[:, None]], dim=1)
        h = h.to(dtype)
        for layer in self.layers:
            h = nn.functional.linear(h, layer.weight.to(dtype), layer.bias.to(dtype)).relu()
        return self.output(h.float())

    def forward(self, origins: Tensor, directions: Tensor, dtype: torch.dtype) -> Tensor:
        """See `ShadowNetwork.forward`; `LIT` for rays without shadow."""
        t_a, t_b, meets = self.span(origins, directions)
        if torch.compiler.is_exporting():
            return torch.where(meets, self._depth(origins, directions, t_a, t_b, dtype), LIT)
        rays = meets.nonzero().squeeze(1)
        parts = (part[rays] for part in (origins, directions, t_a, t_b))
        return torch.full_like(t_a, LIT).index_put((rays,), self._depth(*parts, dtype))

    def _depth(self, origins, directions, t_a, t_b, dtype):
        outputs = self.outputs(origins, directions, t_a, t_b, dtype)
        depth = t_a + outputs[:, 0]
        if self.head == "depth_confidence":
            # confidence > 0.5
            depth = torch.where(outputs[:, 1] > 0, depth, LIT)
        return depth

    def losses(
        self,
        batch: LabelledBatch,
        dead_zone: DeadZone,
        dtype: torch.dtype,
        generator: torch.Generator | None,
    ) -> tuple[Tensor, Tensor]:
        """See `ShadowNetwork.losses`; rays without anything to hit have none."""
        t_a, t_b, meets = self.span(batch.origins, batch.directions)
        rays = meets.nonzero().squeeze(1)
        batch = LabelledBatch(*(part[rays] for part in batch))
        t_a, t_b = t_a[rays], t_b[rays]
        outputs = self.outputs(batch.origins, batch.directions, t_a, t_b, dtype)
        t = t_a + outputs[:, 0]
        loss = dead_zone(t, batch.t_lb, batch.t_ub)
        if self.head == "depth_confidence":
            hit = hits(batch).float()
            error = nn.functional.binary_cross_entropy_with_logits(
                outputs[:, 1], hit, reduction="none"
            )
            loss = hit * loss + CONFIDENCE_WEIGHT * error
        return loss, outputs[:, 0]

    def stored(self) -> dict[str, Tensor]:
        """Quantised weights."""
        return quantise(self.state_dict(), self.storage)

    def restore(self, tensors: dict[str, Tensor]) -> None:
        self.load_state_dict(restore_values(tensors, self.storage))
