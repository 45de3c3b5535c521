"""Variance shadow maps: two moments, Chebyshev's bound (Donnelly and Lauritzen 2006)."""

from functools import partial

from neural_shadows.evaluation.soft_methods.moment_maps import moment_method
from neural_shadows.evaluation.soft_methods.soft_method import SoftMethod
from neural_shadows.shadow_maps.moments import box, powers, variance_visibility


def _vsm(size: int) -> SoftMethod:
    """Filtered by the mean over size × size texels; size is odd."""
    of = partial(powers, count=2)
    return moment_method(box(size), of, variance_visibility)


METHODS = {f"vsm_{size}": _vsm(size) for size in (3, 9)}
