"""Null predictors, independent of the object: a lower bound."""

NO_SHADOW = "no_shadow"  # everything that faces the light is lit
NULL = {NO_SHADOW: "No shadow", "all_dark": "All dark"}  # labels by key


def is_null(method: str) -> bool:
    """Check for a null predictor's key."""
    return method in NULL
