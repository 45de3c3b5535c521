"""Shadow maps of N² texels: plain, 2 × 2 PCF, 16-bit heights."""

from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from neural_shadows.evaluation.look import GREY, SKY, Look
from neural_shadows.evaluation.method import Method, OfBias

if TYPE_CHECKING:
    from neural_shadows.rendering.gbuffer import GBuffer
    from neural_shadows.scenes.scene import Scene
    from neural_shadows.shadow_maps.depth_test import HeightsAt
    from neural_shadows.shadow_maps.shadow_map import ShadowMapSquare

_PLAIN = Look(
    "shadow map",
    GREY,
    "s",
    "■",
    "Renders the scene's depth from the light into a picture of N × N texels; a point "
    "behind its texel is in shadow. The standard of games for decades.",
)
_PCF = Look(
    "filtered shadow map",
    SKY,
    "D",
    "◆",
    "A shadow map that averages the tests of 2 × 2 texels (PCF), for softer steps.",
)
_16_BIT = Look(
    "16-bit shadow map",
    GREY,
    "$◣$",
    "◣",
    "A shadow map whose depths are stored in 16 bits: half the bytes.",
)
LARGEST = 32768  # texels along a side: the thesis's reference [4.1]


def _sun(
    frame: "GBuffer",
    scene: "Scene",
    *,
    size: int,
    whole_map: bool = False,
    pcf: bool,
    sixteen_bit: bool,
) -> OfBias:
    from neural_shadows.shadow_maps.depth_test import depth_test
    from neural_shadows.shadow_maps.shadow_map import receivers_of, shadow_map_square

    (mesh,) = scene.objects
    square = shadow_map_square(mesh.vertices, frame.view.light)
    heights_at = _heights_at(scene, square, size, whole_map, sixteen_bit)
    lit = depth_test(receivers_of(square, frame), size, heights_at, pcf=pcf)
    return lambda depth_bias: frame.visibility(lit(depth_bias))


def _heights_at(
    scene: "Scene", square: "ShadowMapSquare", resolution: int, whole_map: bool, sixteen_bit: bool
) -> "HeightsAt":
    from neural_shadows.shadow_maps.rasterise import rasterised_heights
    from neural_shadows.shadow_maps.trace import looked_up_heights
    from neural_shadows.shadow_maps.unorm16 import from_unorm16, to_unorm16

    if not whole_map:

        def heights_at(texels: np.ndarray) -> np.ndarray:
            heights = looked_up_heights(scene.tracer, square, resolution, texels)
            return from_unorm16(to_unorm16(heights, square), square) if sixteen_bit else heights

        return heights_at
    (mesh,) = scene.objects
    heights = rasterised_heights(mesh.vertices, mesh.faces, square, resolution).ravel()
    if sixteen_bit:
        codes = to_unorm16(heights, square)
        return lambda texels: from_unorm16(codes[texels], square)
    return lambda texels: heights[texels]


def _method(suffix: str, look: Look, *, pcf: bool = False, sixteen_bit: bool = False) -> Method:
    """Maps of one kind.

    Args:
        pcf: 2 × 2 depth tests weighted bilinearly, or that of the nearest texel.
        sixteen_bit: heights as unorm16, or as float32.
    """
    return Method(
        sun=partial(_sun, pcf=pcf, sixteen_bit=sixteen_bit),
        label=f"{{}}² shadow map{suffix}",
        look=look,
        sizes=range(2, LARGEST + 1),
        stored_bytes=lambda resolution: (2 if sixteen_bit else 4) * resolution**2,
    )


METHODS = {
    "shadow_map": _method("", _PLAIN),
    "shadow_map_16bit": _method(", 16 bit", _16_BIT, sixteen_bit=True),
    "shadow_map_pcf": _method(", 2 × 2 PCF", _PCF, pcf=True),
    "shadow_map_pcf_16bit": _method(", 2 × 2 PCF, 16 bit", _16_BIT, pcf=True, sixteen_bit=True),
}
