"""Occupancy field: a trained logit at each vertex near the surface.

Positive is inside. A network of one layer, trilinear interpolation, independent of the ray's
direction. The cube [−1, 1]³ is divided into bricks of 4³ cells. Only bricks touched by the surface
hold values; the others are empty, or enclosed and so in shadow. t_pred is the first sample on the
ray with a positive logit, or on an open sheet, which has no inside, the first change of sign.
(A sheet's shadow thus reaches to the end of its border bricks, where the signs of both sides meet.)
The field is trained on points of the labelled rays by cross-entropy: points before the first hit
are outside, those between the two hits inside.

It may start from signed distances to the mesh; untrained it is then a sparse grid of distances, or,
with one bit a value, of inside flags. Or it starts from distances fitted to the mesh's convex
edges, where shadows end: on the Stanford dragon at 256³ these reach 42.0 dB pooled without
training, a field trained from zero 40.9.
"""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import torch
from torch import Tensor, nn

from neural_shadows.meshes.prepared_mesh import read_prepared
from neural_shadows.networks.object_space.dead_zone_loss import DeadZone
from neural_shadows.networks.object_space.shadow_network import (
    LabelledBatch,
    ShadowNetwork,
    chords,
    hits,
)
from neural_shadows.networks.quantisation import quantise, restore_values
from neural_shadows.representations.depths import LIT
from neural_shadows.representations.distance_bricks.brick_distances import REACH, signed_distances
from neural_shadows.representations.distance_bricks.brick_layout import BrickLayout, lay_out
from neural_shadows.representations.distance_bricks.coded_field import (
    LEVELS_PER_CELL,
    coded,
    decoded,
    levels_of,
)
from neural_shadows.representations.distance_bricks.field_bricks import FieldBricks, field_bricks
from neural_shadows.representations.distance_bricks.field_marching import (
    BRICK,
    BRICK_VERTICES,
    NO_CELLS,
    SAMPLES_PER_CELL,
    SOLID,
    all_cells,
    first_crossings,
)
from neural_shadows.representations.distance_bricks.field_memory import check_memory
from neural_shadows.representations.distance_bricks.field_occlusion import occluded
from neural_shadows.representations.distance_bricks.light_tables import most_bytes
from neural_shadows.representations.distance_bricks.surface_fit import fitted_distances
from neural_shadows.representations.packed_bits import pack_bits, unpack_bits
from neural_shadows.representations.voxels.occupancy import surface_cells
from neural_shadows.scenes.tracing import Tracer

# Smooth limit of logits, for int8. At 8 the surface blurs (−1.1 dB at 128³); without a limit int8's
# steps are too coarse (−3 dB).
LIMIT = 16.0

# Points drawn on each ray in training: half close to its first hit, half anywhere before and
# between the hits. Points in bricks without values are dropped.
POINTS_PER_RAY = 8
NEAR = 0.7  # of the close points' distances, in cells: a normal times an exponential variable
SHEET_REACH = 4.0  # cells around a sheet's hit for its points; beyond may lie another surface

# Share of LIMIT at the largest signed distance; at 1 a logit could not be trained.
START_SHARE = 0.9
CELL_SHARE = START_SHARE / REACH  # share of LIMIT for one cell of distance
# Offsets in cells of a distance surface outwards, see `ShadowNetwork.pushes`: interpolation cuts
# off convex parts. On the Stanford dragon 0.05 is best at 256³ (39.5 dB instead of 37.7), 0.075 at
# 128³ (34.8 instead of 30.2), and for signs −0.1 at 256³.
PUSHES = (-0.2, -0.1, 0.0, 0.025, 0.05, 0.075, 0.1, 0.15)


class OccupancyFieldNetwork(ShadowNetwork):
    """t_pred(o, d) by marching through a field of logits.

    Args:
        resolution: cells along an axis, a multiple of 4.
        surface: `solid`, an object with an inside; or `sheet`, an open surface, whose sign is the
            faces' side.
        start: the values before training: `undecided`, `distances` to a solid's surface, or these
            `fitted` to where its shadows end.
        stored: format in the weight file: `float32`, `float16`, `int8`, `coded`, see `coded_field`,
            or `sign`, one bit each.
        corner_bits: 4 or 8, bits in a CPU's memory of each corner of crossed cells.
    """

    # Gradients of all values are added for each chunk: few, large ones.
    training_chunk = 1 << 15
    # The torch form evaluates all samples of all rays at once.
    query_chunks = {"cpu": 256, "cuda": 1 << 14}

    def __init__(
        self,
        *,
        resolution: int,
        surface: str,
        stored: str,
        start: str = "undecided",
        corner_bits: int = 8,
    ):
        super().__init__()
        self.resolution, self.surface, self.storage = resolution, surface, stored
        self.start, self.corner_bits = start, corner_bits
        if start == "distances":
            self.pushes = PUSHES
        corners = torch.cartesian_prod(*[torch.arange(2)] * 3)
        offsets = torch.tensor([(BRICK + 1) ** 2, BRICK + 1, 1])
        self.register_buffer("corners", corners, persistent=False)
        self.register_buffer("offsets", offsets, persistent=False)
        # A single brick until `prepare` or `restore`: a file may have any resolution.
        self._set_layout(lay_out(np.zeros((1, 1, 1), bool), solid=False))

    def _set_layout(self, layout: BrickLayout) -> None:
        self.register_buffer("grid", torch.from_numpy(layout.grid.reshape(-1)), persistent=False)
        self.register_buffer("table", torch.from_numpy(layout.table.reshape(-1)), persistent=False)
        self._layout = layout
        self.values = nn.Parameter(torch.zeros(layout.count))
        self._bricks: tuple[int, np.ndarray, float] | None = None
        self._field: tuple[tuple[int, float], FieldBricks] | None = None

    def prepare(self, mesh_ply: Path) -> None:
        """Lay out the bricks touched by the surface.

        Raises:
            InputError: too little memory.
        """
        mesh = read_prepared(mesh_ply)
        surface = surface_cells(mesh.vertices, mesh.faces, self.resolution // BRICK)
        check_memory(self.resolution, int(surface.sum()))
        layout = lay_out(surface, self.surface == "solid")
        self._set_layout(layout)
        if self.start != "undecided":
            distances = signed_distances(mesh, layout)
            if self.start == "fitted":
                distances = fitted_distances(mesh, layout, distances).clip(-REACH, REACH)
            self._start_shares = torch.from_numpy(distances) * CELL_SHARE
        if self.surface == "sheet":
            self._tracer = Tracer(mesh.vertices, mesh.faces)
            self._face_normals = mesh.face_normals

    def initialise(self, seed: int) -> None:
        """Set logits near zero, or the start distances."""
        generator = torch.Generator().manual_seed(seed)
        with torch.no_grad():
            if self.start != "undecided":
                self.values.copy_(LIMIT * self._start_shares.atanh())
            else:
                self.values.uniform_(-0.01, 0.01, generator=generator)

    def logits(self) -> Tensor:
        """Logits at all vertices, (count,) float32, in (−LIMIT, LIMIT)."""
        return LIMIT * self.shares()

    def shares(self) -> Tensor:
        """Logits as shares of LIMIT, the stored form."""
        return torch.tanh(self.values / LIMIT)

    def level(self) -> float:
        """Share at the surface; below zero if the surface is pushed out."""
        # With signs the surface is halfway between two vertices, ±1 is half a cell away.
        return -self.push * (2 if self.storage == "sign" else CELL_SHARE)

    def bricks_at(self, p: Tensor) -> Tensor:
        """`grid` entries (n,) int64 at points (n, 3)."""
        size = self.resolution // BRICK
        x, y, z = ((p + 1) * (size / 2)).long().clamp(0, size - 1).unbind(-1)
        return self.grid[(x * size + y) * size + z].long()

    def logits_at(self, p: Tensor, bricks: Tensor, logits: Tensor) -> Tensor:
        """Interpolate logits (n,) at points (n, 3) in nonempty bricks (n,)."""
        size = self.resolution // BRICK
        u = ((p + 1) * (size / 2)).clamp(0, size)
        u = (u - u.long().clamp(max=size - 1)) * BRICK
        cell = u.long().clamp(max=BRICK - 1)
        w = u - cell
        index = bricks * BRICK_VERTICES + (cell * self.offsets).sum(-1)
        index = index[:, None] + (self.corners * self.offsets).sum(-1)
        values = logits.index_select(0, self.table.index_select(0, index.flatten()))
        values = values.unflatten(0, (-1, 2, 2, 2))
        for axis in range(3):
            weight = w[:, axis].view(-1, *[1] * (2 - axis))
            values = values[:, 0] * (1 - weight) + values[:, 1] * weight
        return values

    def losses(
        self,
        batch: LabelledBatch,
        dead_zone: DeadZone,
        dtype: torch.dtype,
        generator: torch.Generator | None,
    ) -> tuple[Tensor, Tensor]:
        """Cross-entropy of points on the rays, without the dead zone."""
        origins, directions, t_lb, t_ub = batch
        chord, hit = chords(origins, directions), hits(batch)
        cell = 2 / self.resolution
        half = POINTS_PER_RAY // 2
        shape = (len(origins), half)
        uniform = torch.rand(
            len(origins), POINTS_PER_RAY, generator=generator, device=origins.device
        )
        normal = torch.randn(shape, generator=generator, device=origins.device)
        spread = -torch.log1p(-torch.rand(shape, generator=generator, device=origins.device))
        low = torch.zeros_like(chord)
        high = torch.minimum(t_ub, chord)
        if self.surface == "sheet":
            # Far from the hit, a sheet's side is unknown.
            low = torch.where(hit, t_lb - SHEET_REACH * cell, low).clamp(min=0)
            high = torch.where(hit, torch.minimum(high, t_lb + SHEET_REACH * cell), low)
        t = low[:, None] + uniform * (high - low)[:, None]
        near = t_lb[:, None] + NEAR * cell * normal * spread
        t[:, :half] = torch.where(hit[:, None], near, t[:, :half])

        inside = (t > t_lb[:, None]) & hit[:, None]
        if self.surface == "sheet":
            inside = inside ^ self._meets_back(origins, directions)[:, None]
        p = origins[:, None] + t[:, :, None] * directions[:, None]
        bricks = self.bricks_at(p)
        valid = (t > low[:, None]) & (t < high[:, None]) & (bricks >= 0)
        logits = self.logits_at(p[valid], bricks[valid], self.logits())
        loss = nn.functional.binary_cross_entropy_with_logits(
            logits, inside[valid].float(), reduction="none"
        )
        return loss, logits

    def _meets_back(self, origins: Tensor, directions: Tensor) -> Tensor:
        """Mask (n,) bool of rays hitting a back face first."""
        d = directions.cpu().numpy()
        _, face = self._tracer.first_hit(origins.cpu().numpy(), d)
        normals = self._face_normals[np.maximum(face, 0)]
        back = (np.einsum("ij,ij->i", normals, d) > 0) & (face >= 0)
        return torch.from_numpy(back).to(origins.device)

    def forward(self, origins: Tensor, directions: Tensor, dtype: torch.dtype) -> Tensor:
        """See `ShadowNetwork.forward`; `LIT` for rays without a crossing.

        All samples of all rays at once, for a GPU and for export. On a CPU `depths` computes the
        same and skips empty space.
        """
        steps = SAMPLES_PER_CELL * self.resolution
        step = 2 / steps
        t = (torch.arange(steps, device=origins.device) + 0.5) * step
        chord = chords(origins, directions)
        p = (origins[:, None] + t[:, None] * directions[:, None]).flatten(0, 1)
        bricks = self.bricks_at(p)
        logits = self.logits() - LIMIT * self.level()
        value = self.logits_at(p, bricks.clamp(min=0), logits).view(-1, steps)
        bricks = bricks.view(-1, steps)
        before = torch.cat([value[:, :1], value[:, :-1]], dim=1)
        follows = (bricks[:, 1:] >= 0) & (bricks[:, :-1] >= 0)
        follows = torch.cat([torch.zeros_like(follows[:, :1]), follows], dim=1)
        if self.surface == "sheet":
            crossing = follows & ((value > 0) != (before > 0))
        else:
            crossing = (bricks == SOLID) | ((bricks >= 0) & (value > 0))
        crossing = crossing & (t < chord[:, None])
        first = crossing.to(torch.uint8).argmax(1, keepdim=True)
        value, before = value.gather(1, first), before.gather(1, first)
        # Where the sample before is in a brick too, the crossing lies between the two.
        back = torch.where(follows.gather(1, first), value / (value - before), 0)
        depth = (t[first] - step * back).squeeze(1)
        return torch.where(crossing.any(1), depth, LIT)

    def depths(self, origins: Tensor, d: Tensor, dtype: torch.dtype) -> Tensor:
        if self.device.type != "cpu":
            return super().depths(origins, d, dtype)
        size = self.resolution // BRICK
        bricks, scale = self._brick_values()
        t_pred = first_crossings(
            origins.numpy(),
            d.numpy(),
            self.grid.view(size, size, size).numpy(),
            bricks,
            SAMPLES_PER_CELL * self.resolution,
            self._cells(bricks),
            np.float32(self.level() / scale),
        )
        return torch.from_numpy(t_pred)

    def points_lit(self, p: Tensor, light: Tensor, dtype: torch.dtype) -> Callable[[float], Tensor]:
        """See `ShadowNetwork.points_lit`; on a CPU by `occluded`, without depths."""
        if self.device.type != "cpu":
            return super().points_lit(p, light, dtype)
        bricks = self.cached_bricks()
        points, to_light = p.contiguous().numpy(), light.numpy()
        return lambda depth_bias: torch.from_numpy(~occluded(points, to_light, bricks, depth_bias))

    def resident_bytes(self) -> int:
        """See `ShadowNetwork.resident_bytes`: on a CPU bricks and a light's tables.

        Of the Stanford dragon at 256³ 2.0 MiB, with 4 bits a corner 1.4. `values` and `table`, their
        sources, are not read.
        """
        if self.device.type != "cpu":
            return super().resident_bytes()
        bricks = self.cached_bricks()
        return bricks.bytes + most_bytes(bricks)

    def cached_bricks(self) -> FieldBricks:
        """Field for `occluded`, cached until weights or push change."""
        state = self.values._version, self.push
        if self._field is None or self._field[0] != state:
            size = self.resolution // BRICK
            values, scale = self._brick_values()
            grid = self.grid.view(size, size, size).numpy()
            level, cells = self.level() / scale, self._cells(values)
            density = 4 if self.start == "undecided" else 2  # it is trained
            self._field = (
                state,
                field_bricks(grid, values, level, self.corner_bits, cells, density),
            )
        return self._field[1]

    def _cells(self, bricks: np.ndarray) -> np.ndarray:
        """Cells of brick values (n, 125) that may be crossed, see `first_crossings`."""
        return all_cells(bricks) if self.surface == "sheet" else NO_CELLS

    def _brick_values(self) -> tuple[np.ndarray, float]:
        """Stored values of each brick, (bricks, 125), and their unit share.

        Cached until the weights change, because each frame of an evaluation needs them.
        """
        if self._bricks is None or self._bricks[0] != self.values._version:
            shares, scale = self.shares().detach(), 1.0
            if self.storage == "sign":
                shares = (shares > 0).to(torch.int8) * 2 - 1
            elif self.storage == "int8":
                shares, scale = quantise({"": shares}, "int8").values()
            elif self.storage == "coded":  # the middle of a level, in half levels
                shares = torch.from_numpy(2 * self._levels() + 1)
                scale = CELL_SHARE / LEVELS_PER_CELL / 2
            bricks = shares[self.table.long()].view(-1, BRICK_VERTICES)
            self._bricks = self.values._version, bricks.numpy(), float(scale)
        return self._bricks[1:]

    def _levels(self) -> np.ndarray:
        return levels_of(self.shares().detach().cpu().numpy() / CELL_SHARE)

    def stored(self) -> dict[str, Tensor]:
        """See `ShadowNetwork.stored`; a bit for each surface brick."""
        if self.storage == "coded":
            return coded(self._layout, self._levels())
        shares = self.shares().detach()
        if self.storage == "sign":
            values = {"values": pack_bits(shares > 0)}
        else:
            values = quantise({"values": shares}, self.storage)
        return values | {"bricks": pack_bits(self.grid >= 0)}

    def restore(self, tensors: dict[str, Tensor]) -> None:
        tensors = dict(tensors)
        size = self.resolution // BRICK
        if self.storage == "coded":
            layout, levels = decoded(tensors, size, self.surface == "solid")
            self._set_layout(layout)
            shares = torch.from_numpy(levels + np.float32(0.5)) * (CELL_SHARE / LEVELS_PER_CELL)
            self.load_state_dict({"values": LIMIT * shares.atanh()})
            return
        surface = unpack_bits(tensors.pop("bricks"), size**3).view(size, size, size).numpy()
        layout = lay_out(surface, self.surface == "solid")
        self._set_layout(layout)
        if self.storage == "sign":
            values = 2.0 * unpack_bits(tensors["values"], layout.count) - 1
        else:
            values = restore_values(tensors, self.storage)["values"]
        # Clamped below the limit, where the inverse is infinite.
        self.load_state_dict({"values": LIMIT * values.clamp(-0.99999, 0.99999).atanh()})
