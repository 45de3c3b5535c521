"""Null predictors, independent of the object: a lower bound."""

from neural_shadows.evaluation.look import GREY, Look

NO_SHADOW = "no_shadow"  # everything that faces the light is lit
NULL = {NO_SHADOW: "No shadow", "all_dark": "All dark"}  # labels by key
VISIBILITY = {NO_SHADOW: 1.0, "all_dark": 0.0}  # of all that faces the light
LOOK = Look(
    "no method",
    GREY,
    "o",
    "○",
    "Draws no shadow at all, or all of it: what is no better has learned nothing.",
)


def is_null(method: str) -> bool:
    """Check for a null predictor's key."""
    return method in NULL
