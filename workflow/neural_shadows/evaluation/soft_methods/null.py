"""Null predictors: visibility by facing the light alone."""

from neural_shadows.evaluation import null_predictors
from neural_shadows.evaluation.soft_method import SoftMethod

LOOK = null_predictors.LOOK
METHODS = {
    key: SoftMethod(
        label=label,
        null=True,
        constant=null_predictors.VISIBILITY[key],
        texel_floats=0,
        of_radius=False,
    )
    for key, label in null_predictors.NULL.items()
}
