"""Moment shadow maps: four moments, Hamburger (Peters and Klein 2015)."""

from functools import partial

from neural_shadows.evaluation.soft_methods.moment_maps import moment_method
from neural_shadows.evaluation.soft_methods.soft_method import SoftMethod
from neural_shadows.shadow_maps.moments import box, gaussian, hamburger_visibility, powers


def _msm(size: int, sigma: float | None = None) -> SoftMethod:
    """Filtered over size × size texels, odd.

    Args:
        sigma: of a Gaussian, in texels (Hu et al. 2025, 6.1); None for the mean, for the kernels
            that Datta et al. 2022 name by their sizes alone.
    """
    kernel = box(size) if sigma is None else gaussian(size, sigma)
    return moment_method(kernel, partial(powers, count=4), hamburger_visibility)


METHODS = {"msm_3": _msm(3), "msm_9": _msm(9), "msm_15": _msm(15, sigma=3.0)}
