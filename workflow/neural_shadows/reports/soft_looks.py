"""How each family of methods for soft shadows looks, the same everywhere."""

from collections.abc import Mapping
from typing import Any

from neural_shadows.evaluation.soft_method_names import LABELS, NULL, is_network
from neural_shadows.reports.figures.style import COLOURS
from neural_shadows.reports.method_look import Look

BLUE, RED, GREEN, PINK, YELLOW, SKY, _ = COLOURS
SOFT_LOOKS = {
    "hard": Look("shadow map", "#777777", "s", "■", "One test a pixel against the light's map."),
    "pcf": Look(
        "percentage-closer filtering",
        SKY,
        "D",
        "◆",
        "Averages the tests round a pixel's texel; as blurred everywhere.",
    ),
    "pcss": Look(
        "percentage-closer soft shadows",
        BLUE,
        "P",
        "✚",
        "Looks for blockers first, and filters as widely as they ask.",
    ),
    "moments": Look(
        "filtered moments (VSM, EVSM, MSM)",
        YELLOW,
        "^",
        "▲",
        "Blurs powers of depth before they are looked up.",
    ),
    "rt": Look("rays", GREEN, "o", "●", "Sends so many rays from each pixel to the light."),
    "field": Look(
        "rays through occupancy fields",
        "#000000",
        "p",
        "⬟",
        "Rays through a sparse grid of signed distances of each object.",
    ),
    "cone": Look(
        "cones through occupancy fields",
        "#777777",
        "h",
        "⬢",
        "Walks once from a point to the light, and keeps how near it comes to each object's surface.",
    ),
    "svgf": Look("rays, SVGF-like filter", PINK, "v", "▼", "Rays, smoothed within surfaces."),
    "oidn": Look("rays, Open Image Denoise", RED, "X", "✕", "Rays, denoised by a network."),
    "network": Look(
        "networks on frames",
        "#000000",
        "*",
        "★",
        "Answers a whole frame from its buffers and the light's map.",
    ),
    "base": Look("what networks begin with", "#000000", "<", "◄", "The map's shadow, as stored."),
    "exact": Look(
        "the exact shadow",
        "#000000",
        "d",
        "◈",
        "What a perfect answer at the middle of each pixel still lacks of the antialiased target.",
    ),
    # Of a family that has none of its own here.
    "other": Look("other methods", RED, "d", "⬧", "A method of this checkout's own."),
    "null": Look("no method", "#777777", "o", "○", "Draws no shadow at all, or all of it."),
}


def family_of(method: str) -> str:
    """The key in `SOFT_LOOKS` of a method of the registry."""
    if is_network(method):
        return "network"
    if method in NULL:
        return "null"
    first, _, rest = method.partition("_")
    if first == "rt":
        kind = rest.partition("_")[2]
        first = "rt" if kind in ("", "spread") else kind
    if first in ("vsm", "evsm", "msm"):
        first = "moments"
    return first if first in SOFT_LOOKS else "other"


UNITS = {"metres": "m", "scene_sizes": "S"}


def light_names(about: Mapping[str, Any]) -> list[str]:
    """What the lights of a part of a frame set are called, in its order; `about`: its JSON."""
    unit = UNITS[about.get("radius_unit", "metres")]
    return [light_name(radius, unit) for radius in about.get("given_radii", about["radii"])]


def light_name(radius: float, unit: str) -> str:
    """What a light of a radius is called; `unit`: m, or S for sizes of the scene."""
    return f"light of {radius:.3g} {unit} radius" if radius else "point light"


# By label, as tables call them.
SOFT_METHODS = {label: SOFT_LOOKS[family_of(method)] for method, label in LABELS.items()}
