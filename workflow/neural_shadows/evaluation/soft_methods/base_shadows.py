"""What networks begin with: as a frame's buffers hold it, a user's own frames' too."""

from neural_shadows.evaluation.soft_methods.soft_method import SoftMethod
from neural_shadows.frames.buffers import LIT

METHODS = {
    f"base_{name}": SoftMethod(channel=name, texel_floats=0, of_radius=False) for name in LIT
}
