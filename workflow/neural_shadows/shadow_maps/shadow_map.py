"""Shadow maps of a directional light: their square and receivers [4.1].

A map's heights come from `trace` or `rasterise`; `depth_test` compares points with them.
"""

from dataclasses import dataclass

import numpy as np

from neural_shadows.rendering.gbuffer import GBuffer
from neural_shadows.scenes.lights import light_basis
from neural_shadows.shadow_maps.slope import slope

# Rays start this far beyond the object, clear of it by far more than float32 rounding.
_CLEARANCE = 0.01


@dataclass(frozen=True, eq=False)
class ShadowMapSquare:
    """The square of one light's shadow maps, and the object's heights."""

    basis: np.ndarray  # (3, 3) float64, rows u, v, light: see `light_basis`
    corner: np.ndarray  # (2,) float64, the square's least u and v
    side: float  # of the square, in normalised space
    lowest: float  # height along the light of the object's lowest vertex
    highest: float  # and of its highest

    @property
    def top(self) -> float:
        """Starting height of rays along the light, above all vertices."""
        return self.highest + _CLEARANCE


@dataclass(frozen=True, eq=False)
class Receivers:
    """Shading points for maps of any resolution: k of m on the map."""

    square: ShadowMapSquare
    count: int  # m
    on_map: np.ndarray  # (k,) int64, indices into the m points
    place: np.ndarray  # (2, k) float32 in [0, 1), across the square along u and v
    height: np.ndarray  # (k,) float32, along the light: larger is nearer to it
    slope: np.ndarray  # (k,) float32, see `slope`


def shadow_map_square(vertices: np.ndarray, light: np.ndarray) -> ShadowMapSquare:
    """Smallest square round projected vertices (V, 3), in the light's basis [4.1].

    Across its shorter extent the object lies in the middle.
    """
    basis = light_basis(light)
    projected = basis.astype(np.float32) @ vertices.T
    low, high = (bound.astype(np.float64) for bound in (projected.min(1), projected.max(1)))
    side = float((high - low)[:2].max())
    corner = (low + high)[:2] / 2 - side / 2
    return ShadowMapSquare(basis, corner, side, float(low[2]), float(high[2]))


def receivers_of(square: ShadowMapSquare, frame: GBuffer) -> Receivers:
    """Project the points on a frame's lit side onto its light's square, for any resolution."""
    u, v, height = square.basis.astype(np.float32) @ frame.p.T
    corner, side = square.corner.astype(np.float32), np.float32(square.side)
    place = np.stack([(u - corner[0]) / side, (v - corner[1]) / side])
    on_map = np.flatnonzero(((place >= 0) & (place < 1)).all(0))
    return Receivers(
        square=square,
        count=len(frame.p),
        on_map=on_map,
        place=place[:, on_map],
        height=height[on_map],
        slope=slope(frame.cos_geometric[on_map]),
    )
