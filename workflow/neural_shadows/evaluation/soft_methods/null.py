"""What knows nothing: no shadow at all, and all of it."""

import numpy as np

from neural_shadows.evaluation.soft_methods.soft_method import SoftMethod
from neural_shadows.frames.soft_frame import SoftFrame


def null(label: str, visibility: float) -> SoftMethod:
    """The same visibility everywhere that faces the light."""

    def answer(frame: SoftFrame, radius: float) -> np.ndarray:
        return np.full(len(frame.surface.p), visibility, np.float32)

    return SoftMethod(label, answer, texel_floats=0, of_radius=False)
