"""The look of each kind of method for hard shadows, and of networks of one object."""

from neural_shadows.evaluation.look import BLACK, BLUE, GREEN, ORANGE, PINK, YELLOW, Look
from neural_shadows.evaluation.null_predictors import NULL
from neural_shadows.evaluation.registry import (
    RAY_TRACED,
    VIEW_METHODS,
    family_and_size,
    family_look,
    unbiased,
)
from neural_shadows.settings.records import Row

REFERENCE = "reference"

# By kind, in a legend's order: a colour for each family, a symbol for each kind.
LOOKS = {
    REFERENCE: Look(
        "exact shadow",
        BLACK,
        "*",
        "★",
        "Traces a ray from each pixel to the light: exact, and the reference of all others.",
    ),
    **{key: family_look(key) for key in VIEW_METHODS if key not in NULL},
    "frequency": Look(
        "thesis's network",
        ORANGE,
        (6, 1, 0),
        "✶",
        "The thesis's method: a small neural network maps a ray through the object's sphere to the "
        "depth at which shadow begins.",
    ),
    "occupancy_field": Look(
        "occupancy field",
        BLUE,
        "$▮$",
        "▮",
        "A grid of small bricks at the object's surface, trained for occupancy; shadow rays march "
        "through it.",
    ),
    "ray_grid": Look(
        "ray grid",
        PINK,
        "$♠$",
        "♠",
        "Looks up trained values at points along the ray, and decodes them by a small network.",
    ),
    "occupancy_ray_grid": Look(
        "clipped ray grid",
        PINK,
        "$♣$",
        "♣",
        "A ray grid with points only at the surface.",
    ),
    "hash_grid": Look(
        "hash grid",
        PINK,
        "$♥$",
        "♥",
        "A ray grid that keeps its values in hash tables of several resolutions.",
    ),
    "mesh": Look(
        "mesh",
        GREEN,
        "$▰$",
        "▰",
        "Traces rays through the triangles themselves, decimated or whole. No training.",
    ),
    "distances": Look(
        "grid without training",
        YELLOW,
        "$◗$",
        "◗",
        "The occupancy field's grid, filled without training: with distances to the surface, with "
        "distances fitted so that shadows end in the right place, or only with whether a point is inside.",
    ),
    "voxel_dag": Look(
        "voxels",
        YELLOW,
        "$▚$",
        "▚",
        "Small cubes, full or empty, equal ones stored once. No training.",
    ),
    "height_map": Look(
        "heights",
        YELLOW,
        "$▬$",
        "▬",
        "The height of a terrain over its ground plan, marched. No training.",
    ),
    **{key: family_look(key) for key in NULL},
}


def kind_of(row: Row) -> str:
    """The key in `LOOKS` of the method of a row of `sections.rows`.

    Other kinds of networks are keys, too (see `look_of_kind`).
    """
    method, encoding = unbiased(row["method"]), row["encoding"]
    if encoding is not None:
        built = encoding == "occupancy_field" and not row["trained"]
        return "distances" if built else encoding
    return REFERENCE if method == RAY_TRACED else family_and_size(method)[0] or REFERENCE


def look_of(row: Row) -> Look:
    """The look of the method of a row of `sections.rows`."""
    return look_of_kind(kind_of(row))


def look_of_kind(kind: str) -> Look:
    """The look of a kind of method; a plain one of the user's own kinds."""
    return LOOKS.get(kind, Look(kind.replace("_", " "), "#555555", "8", "⬤", ""))
