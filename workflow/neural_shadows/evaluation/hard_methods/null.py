"""Null predictors: visibility by facing the light alone."""

from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from neural_shadows.evaluation import null_predictors
from neural_shadows.evaluation.hard_method import HardMethod, ShadowMethod, whatever_bias

if TYPE_CHECKING:
    from neural_shadows.scenes.scene import Scene


def _of_scene(scene: "Scene", size: int, whole_map: bool, *, lit: float) -> ShadowMethod:
    return lambda frame: whatever_bias(frame.visibility(np.full(len(frame.p), lit)))


METHODS = {
    key: HardMethod(
        label, null_predictors.LOOK, partial(_of_scene, lit=null_predictors.VISIBILITY[key])
    )
    for key, label in null_predictors.NULL.items()
}
