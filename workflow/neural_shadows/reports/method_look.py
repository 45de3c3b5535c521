"""How each kind of method looks, the same everywhere: its name, colour, marker and symbol."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from neural_shadows.evaluation.method_names import family_of, is_map, is_null, unbiased

REFERENCE = "reference"


@dataclass(frozen=True)
class Look:
    """What a kind of method is called and looks like.

    `colour` is of Okabe and Ito's, or a grey; `marker` is matplotlib's, and `symbol` the character
    that looks like it; `sentence` says what the method does.
    """

    name: str
    colour: str
    marker: str
    symbol: str
    sentence: str


# In a legend's order: by colour what is of one family, and no two of one symbol.
LOOKS = {
    REFERENCE: Look(
        "exact shadow",
        "#000000",
        "*",
        "★",
        "Follows a ray from each pixel towards the light: exact, and what all others are held to.",
    ),
    "map": Look(
        "shadow map",
        "#777777",
        "s",
        "■",
        "Renders the scene's depth from the light into a picture of N × N texels; a point that "
        "lies deeper than its texel is in shadow. What games have done for decades.",
    ),
    "pcf": Look(
        "filtered shadow map",
        "#56b4e9",
        "D",
        "◆",
        "A shadow map that averages the tests of 2 × 2 texels (PCF), for softer steps.",
    ),
    "map_16bit": Look(
        "16-bit shadow map",
        "#777777",
        "p",
        "⬟",
        "A shadow map whose depths are stored in 16 bits: half the bytes.",
    ),
    "frequency": Look(
        "thesis's network",
        "#d55e00",
        "o",
        "●",
        "The thesis's method: a small neural network is given a ray through the object's sphere, "
        "and answers the depth behind which all is in shadow.",
    ),
    "occupancy_field": Look(
        "occupancy field",
        "#0072b2",
        "P",
        "✚",
        "A grid of small bricks at the object's surface, trained to say what is inside; shadow "
        "rays are marched through it.",
    ),
    "ray_grid": Look(
        "ray grid",
        "#cc79a7",
        "v",
        "▼",
        "Looks up trained values at points along the ray, and a small network reads them.",
    ),
    "occupancy_ray_grid": Look(
        "clipped ray grid",
        "#cc79a7",
        "^",
        "▲",
        "A ray grid whose points lie only where the surface is.",
    ),
    "hash_grid": Look(
        "hash grid",
        "#cc79a7",
        "H",
        "⬣",
        "A ray grid that keeps its values in hash tables of several resolutions.",
    ),
    "mesh": Look(
        "mesh",
        "#009e73",
        "h",
        "⬢",
        "Traces rays through the triangles themselves, decimated or whole. No training.",
    ),
    "distances": Look(
        "untrained grid",
        "#e69f00",
        "X",
        "✕",
        "The occupancy field's grid, filled with distances to the surface (or with their signs) "
        "instead of trained.",
    ),
    "voxel_dag": Look(
        "voxels",
        "#e69f00",
        "<",
        "◄",
        "Small cubes that are full or empty, equal ones stored once. No training.",
    ),
    "height_map": Look(
        "heights",
        "#e69f00",
        ">",
        "►",
        "The height of a terrain over its ground plan, marched. No training.",
    ),
    "null": Look(
        "no method",
        "#777777",
        "o",
        "○",
        "Draws no shadow at all, or all of it: what is no better has learned nothing.",
    ),
}


def kind_of(row: Mapping[str, Any]) -> str:
    """The key in `LOOKS` of the method of a row of `config.rows_of`.

    A kind of network that is not there is a key all the same (`look_of_kind` shows it).
    """
    method, encoding = unbiased(row["method"]), row["encoding"]
    if encoding is not None:
        built = encoding == "occupancy_field" and not row["trained"]
        return "distances" if built else encoding
    if is_null(method):
        return "null"
    if not is_map(method):
        return REFERENCE  # `ray_traced` is the same
    family = family_of(method)
    return "map_16bit" if family.sixteen_bit else "pcf" if family.pcf else "map"


def look_of(row: Mapping[str, Any]) -> Look:
    """The look of the method of a row of `config.rows_of`."""
    return look_of_kind(kind_of(row))


def look_of_kind(kind: str) -> Look:
    """The look of a kind of method; of one of the user's own a plain one."""
    return LOOKS.get(kind, Look(kind.replace("_", " "), "#555555", "8", "⬤", ""))
