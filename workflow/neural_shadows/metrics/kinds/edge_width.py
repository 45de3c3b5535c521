"""Width of a point light's shadow edges, in pixels: how sharp they are."""

from dataclasses import replace

import numpy as np

from neural_shadows.metrics.kinds.penumbra_width import penumbra_width
from neural_shadows.metrics.metric import Metric, Pixels

_WIDTH = {"unit": "pixels", "digits": 1, "better": None, "lights": ("soft",)}
METRICS = {
    "edge_width": Metric("edge width", **_WIDTH),
    "edge_width_reference": Metric("edge width", "of the reference", **_WIDTH),
}


def of_visibility(visibility: np.ndarray, target: np.ndarray, pixels: Pixels) -> dict[str, float]:
    """`edge_width` of both under a point light; NaN under others, and where the hard shadow is unknown."""
    of_point = pixels.hard is not None and np.array_equal(target, pixels.hard)
    images = {"edge_width": visibility, "edge_width_reference": target}
    return {
        name: edge_width(image, pixels) if of_point else float("nan")
        for name, image in images.items()
    }


def edge_width(visibility: np.ndarray, pixels: Pixels) -> float:
    """Mean width of the hard shadow's edges, pixels, where the image has an edge, too. About 8 at most.

    `penumbra_width` of pixels near an edge of both alone (`Pixels.near_edges`). So an edge that is missing,
    or elsewhere, does not count, nor does a light grey far from any. NaN without an edge.

    Args:
        visibility: (H, W) float32 in [0, 1]; pixels: with `hard`, of a point light.
    """
    shown = replace(pixels, hard=visibility).near_edges
    return penumbra_width(visibility, pixels.valid & pixels.near_edges & shown, pixels.hard)
