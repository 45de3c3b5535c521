"""A hard-shadow method without a network, and its settings."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from neural_shadows.evaluation.look import Look

if TYPE_CHECKING:  # the graph needs metadata alone
    from neural_shadows.rendering.gbuffer import GBuffer
    from neural_shadows.scenes.scene import Scene

# Of a depth bias, in sphere radii, the visibility of the light at a frame's n surface points, (n,)
# float32; 0 where a surface is turned from the light.
OfBias = Callable[[float], np.ndarray]
ShadowMethod = Callable[["GBuffer"], OfBias]


@dataclass(frozen=True)
class HardMethod:
    """One method, or one for each size N, as FAMILY_N.

    Args:
        label: its name in tables; `{}` stands for N.
        of_scene: of a scene, N and whether to render whole maps (see `classic_method`), the method.
        sizes: allowed N; empty of a method without one.
        stored_bytes: of a size, in a file as in memory; None if it stores nothing.
    """

    label: str
    look: Look
    of_scene: "Callable[[Scene, int, bool], ShadowMethod]"
    sizes: range = range(0)
    stored_bytes: Callable[[int], int] | None = None


def whatever_bias(visibility: np.ndarray) -> OfBias:
    """The same visibility at any depth bias."""
    return lambda depth_bias: visibility
