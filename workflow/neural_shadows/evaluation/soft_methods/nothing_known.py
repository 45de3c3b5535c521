"""What knows nothing but which side faces the light: any other method has to be better."""

from neural_shadows.evaluation.soft_methods.soft_method import SoftMethod

METHODS = {
    "no_shadow": SoftMethod(constant=1.0, texel_floats=0, of_radius=False),
    "all_dark": SoftMethod(constant=0.0, texel_floats=0, of_radius=False),
}
