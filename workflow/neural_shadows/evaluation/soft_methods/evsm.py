"""Exponential variance shadow maps (Lauritzen and McCool 2008)."""

from neural_shadows.evaluation.soft_methods.moment_maps import moment_method
from neural_shadows.evaluation.soft_methods.soft_method import SoftMethod
from neural_shadows.shadow_maps.moments import box, exponential_visibility, warped


def _evsm(size: int) -> SoftMethod:
    """Filtered by the mean over size × size texels; size is odd."""
    return moment_method(box(size), warped, exponential_visibility)


METHODS = {"evsm_9": _evsm(9)}
