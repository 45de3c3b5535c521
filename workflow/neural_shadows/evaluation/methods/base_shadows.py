"""Base shadows from a frame's buffers, also of a user's frames."""

from neural_shadows.evaluation.look import BLACK, Look
from neural_shadows.evaluation.method import Method

LOOK = Look("base shadows", BLACK, "<", "◄", "The shadow that a network begins with, as stored.")

_LABELS = {"hard": "Base: shadow map", "pcf": "Base: PCF 2 × 2", "msm": "Base: MSM 3 × 3, σ 0.55"}
METHODS = {
    f"base_{channel}": Method(label=label, channel=channel, texel_floats=0, of_radius=False)
    for channel, label in _LABELS.items()
}
