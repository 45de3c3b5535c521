"""Null predictors: visibility by facing the light alone."""

from neural_shadows.evaluation.look import GREY, Look
from neural_shadows.evaluation.method import Method
from neural_shadows.evaluation.null_predictors import NO_SHADOW, NULL

LOOK = Look(
    "no method",
    GREY,
    "o",
    "○",
    "Draws no shadow at all, or all of it: what is no better has learned nothing.",
)
METHODS = {
    key: Method(
        label=label,
        null=True,
        constant=1.0 if key == NO_SHADOW else 0.0,
        texel_floats=0,
        of_radius=False,
    )
    for key, label in NULL.items()
}
