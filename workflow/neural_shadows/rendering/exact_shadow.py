"""The exact shadow of a frame: rays towards the light."""

import numpy as np

from neural_shadows.rendering.gbuffer import GBuffer
from neural_shadows.scenes.tracing import Tracer


def exact_visibility(tracer: Tracer, frame: GBuffer) -> np.ndarray:
    """Visibility (n,) float32, 0 or 1: an occlusion ray from each point on the lit side."""
    towards = np.tile(frame.view.light.astype(np.float32), (len(frame.p), 1))
    return frame.visibility(~tracer.occluded(frame.p, towards))
