"""The exact shadow of a frame, by occlusion rays."""

import numpy as np

from neural_shadows.rendering.gbuffer import GBuffer
from neural_shadows.scenes.tracing import Tracer


def exact_visibility(tracer: Tracer, frame: GBuffer) -> np.ndarray:
    """Trace visibility (n,) float32, 0 or 1, on the lit side."""
    to_light = np.tile(frame.view.light.astype(np.float32), (len(frame.p), 1))
    return frame.visibility(~tracer.occluded(frame.p, to_light))
