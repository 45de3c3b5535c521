"""Depth test of shading points against a shadow map [4.1]."""

from collections.abc import Callable

import numpy as np

from neural_shadows.shadow_maps.shadow_map import Receivers

# Heights (t,) float32 of texels (t,), row · resolution + column, in a map of one resolution.
HeightsAt = Callable[[np.ndarray], np.ndarray]


def depth_test(
    receivers: Receivers,
    resolution: int,
    heights_at: HeightsAt,
    *,
    pcf: bool = False,
) -> Callable[[float], np.ndarray]:
    """Compare receivers with a map of resolution² texels, for any depth bias [4.1].

    Shadowed where the stored surface is nearer to the light by more than the bias
    h · min(0.5 + 0.75 tan θ, 20) + 1e-4 + depth bias, with h the world size of a texel and θ the
    angle between geometric normal and light. Points off the map are lit.

    Args:
        pcf: weight the tests against the four texels round a receiver bilinearly, as graphics
            hardware does (percentage-closer filtering, Reeves et al. 1987); else that of the
            receiver's texel.

    Returns:
        a function of the depth bias, in sphere radii, that gives the visibility of all m facing
        points, (m,) float32: 0 or 1, with PCF between.
    """
    texels, shares = (
        texels_round(receivers, resolution) if pcf else (texels_of(receivers, resolution), ())
    )
    heights = heights_at(texels.ravel()).reshape(texels.shape)
    bias = receivers.slope * np.float32(receivers.square.side / resolution) + np.float32(1e-4)

    def visibility(depth_bias: float) -> np.ndarray:
        lit = receivers.height + (bias + np.float32(depth_bias)) >= heights
        lit = lit.astype(np.float32)
        for share in shares:
            lit = lit[0] + (lit[1] - lit[0]) * share
        result = np.ones(receivers.count, np.float32)
        result[receivers.on_map] = lit
        return result

    return visibility


def texels_of(receivers: Receivers, resolution: int) -> np.ndarray:
    """Texel of each receiver, row · resolution + column: (k,) int64.

    Integers, since float32 cannot number the 2³⁰ texels of a 32768² map.
    """
    column, row = (receivers.place * np.float32(resolution)).astype(np.int64)
    return row * resolution + column


def texels_round(
    receivers: Receivers, resolution: int
) -> tuple[np.ndarray, tuple[np.ndarray, np.ndarray]]:
    """The four texels round each receiver: (2, 2, k) int64, by row and column.

    And the receiver's fractions from the first row to the second, and from the first column to the
    second: (k,) float32 each in [0, 1]. At the rim of the map the outermost texels stand for those
    beyond, as hardware's "clamp to edge".
    """
    place = receivers.place * np.float32(resolution) - np.float32(0.5)
    first = np.floor(place)
    across, along = place - first
    column, row = (
        np.clip(np.stack([index, index + 1]).astype(np.int64), 0, resolution - 1) for index in first
    )
    return row[:, None] * resolution + column[None], (along, across)
