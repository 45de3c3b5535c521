"""Shadow maps of a directional light, traced only where some shading point looks them up [4.1]."""

from dataclasses import dataclass

import numpy as np

from neural_shadows.rendering.gbuffer import GBuffer
from neural_shadows.scenes.lights import light_basis
from neural_shadows.scenes.tracing import Tracer

# Rays start this far beyond the object, clear of it by far more than float32 rounding.
_CLEARANCE = 0.01


@dataclass(frozen=True, eq=False)
class ShadowMapSquare:
    """The square that shadow maps of one light cover, and where their rays start."""

    basis: np.ndarray  # (3, 3) float64, rows u, v, light: see `light_basis`
    corner: np.ndarray  # (2,) float64, the square's least u and v
    side: float  # of the square, in normalised space
    top: float  # height along the light that the rays start from, above all vertices


@dataclass(frozen=True, eq=False)
class Receivers:
    """Shading points as maps of every resolution look at them: those k of m on the map."""

    square: ShadowMapSquare
    count: int  # m
    on_map: np.ndarray  # (k,) int64, indices into the m points
    place: np.ndarray  # (2, k) float32 in [0, 1), across the square along u and v
    height: np.ndarray  # (k,) float32, along the light: larger is nearer to it
    slope: np.ndarray  # (k,) float32, 0.5 + 0.75 tan θ, at most 20


def shadow_map_square(vertices: np.ndarray, light: np.ndarray) -> ShadowMapSquare:
    """Smallest square, aligned to the light's basis, round the projected vertices (V, 3) [4.1].

    Across its shorter extent the object lies in the middle.
    """
    basis = light_basis(light)
    projected = basis.astype(np.float32) @ vertices.T
    low, high = (bound.astype(np.float64) for bound in (projected.min(1), projected.max(1)))
    side = float((high - low)[:2].max())
    corner = (low + high)[:2] / 2 - side / 2
    return ShadowMapSquare(basis, corner, side, float(high[2]) + _CLEARANCE)


def receivers_of(square: ShadowMapSquare, frame: GBuffer) -> Receivers:
    """Project the points on a frame's lit side onto its light's square, for any resolution."""
    u, v, height = square.basis.astype(np.float32) @ frame.p.T
    corner, side = square.corner.astype(np.float32), np.float32(square.side)
    place = np.stack([(u - corner[0]) / side, (v - corner[1]) / side])
    on_map = np.flatnonzero(((place >= 0) & (place < 1)).all(0))
    # tan θ from 1% up: below it the bound of 20 holds anyway (tan θ = 26 reaches it).
    tangent = np.sqrt(1 / np.clip(frame.cos_geometric[on_map], 0.01, 1) ** 2 - 1)
    return Receivers(
        square=square,
        count=len(frame.p),
        on_map=on_map,
        place=place[:, on_map],
        height=height[on_map],
        slope=np.minimum(0.5 + 0.75 * tangent, 20),
    )


def texels_of(receivers: Receivers, resolution: int) -> np.ndarray:
    """Texel that each receiver falls in, row · resolution + column: (k,) int64.

    Integers, since float32 cannot number the 2³⁰ texels of a 32768² map.
    """
    column, row = (receivers.place * np.float32(resolution)).astype(np.int64)
    return row * resolution + column


def texel_heights(
    tracer: Tracer, square: ShadowMapSquare, resolution: int, texels: np.ndarray
) -> np.ndarray:
    """Height along the light of the first surface under each texel's centre, −∞ for none.

    Args:
        texels: (t,) row · resolution + column; `np.arange(resolution**2)` for the whole map.

    Returns:
        (t,) float32.
    """
    u, v, light = square.basis
    row, column = np.divmod(texels, resolution)
    across = square.corner[0] + (column + 0.5) * (square.side / resolution)
    along = square.corner[1] + (row + 0.5) * (square.side / resolution)
    origins = np.empty((len(texels), 3), np.float32)
    for k in range(3):
        origins[:, k] = across * u[k] + along * v[k] + square.top * light[k]
    directions = np.tile(-light.astype(np.float32), (len(texels), 1))
    t, _ = tracer.first_hit(origins, directions)
    return np.float32(square.top) - t


def depth_test(receivers: Receivers, heights: np.ndarray, resolution: int) -> np.ndarray:
    """Compare receivers with the heights (k,) stored in their texels: lit, (m,) bool [4.1].

    Shadowed where the stored surface is nearer to the light by more than the bias
    h · min(0.5 + 0.75 tan θ, 20) + 1e-4, with h the world size of a texel and θ the angle
    between geometric normal and light. Points off the map are lit.
    """
    bias = receivers.slope * np.float32(receivers.square.side / resolution) + np.float32(1e-4)
    lit = np.ones(receivers.count, bool)
    lit[receivers.on_map] = receivers.height + bias >= heights
    return lit


def shadow_map_lit(
    tracer: Tracer, receivers: Receivers, resolution: int, whole: bool = False
) -> np.ndarray:
    """What a shadow map of resolution² texels says of each facing point: lit, (m,) bool [4.1].

    Args:
        whole: render each texel, as a renderer does before it knows its receivers; else those
            alone that some receiver falls in, which gives the same values.
    """
    texels = texels_of(receivers, resolution)
    square = receivers.square
    if resolution**2 > 4 * len(texels) and not whole:
        # Where texels outnumber receivers, few are shared (at 2048² a twentieth of 500,000): a ray
        # each is cheaper than finding the distinct ones in a table of the whole map.
        return depth_test(receivers, texel_heights(tracer, square, resolution, texels), resolution)
    used = np.full(resolution**2, whole)
    used[texels] = True
    used = np.flatnonzero(used)
    table = np.empty(resolution**2, np.float32)
    table[used] = texel_heights(tracer, square, resolution, used)
    return depth_test(receivers, table[texels], resolution)
