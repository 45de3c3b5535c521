"""All methods for soft shadows by their keys, in the order of tables."""

from functools import partial

from neural_shadows.evaluation.soft_methods.denoised import oidn_denoised, svgf_denoised
from neural_shadows.evaluation.soft_methods.evsm import evsm
from neural_shadows.evaluation.soft_methods.hard_map import HARD
from neural_shadows.evaluation.soft_methods.msm import msm
from neural_shadows.evaluation.soft_methods.null import null
from neural_shadows.evaluation.soft_methods.pcf import DISC_PCF, box_pcf
from neural_shadows.evaluation.soft_methods.pcss import PCSS, PCSS_POST
from neural_shadows.evaluation.soft_methods.ray_traced import ray_traced
from neural_shadows.evaluation.soft_methods.soft_method import SoftMethod
from neural_shadows.evaluation.soft_methods.vsm import vsm

_BY_RAYS = {"texel_floats": 0, "by_rays": True}


def _rays(count: int) -> SoftMethod:
    label = f"{count} ray{'s' if count > 1 else ''}"
    return SoftMethod(label, partial(ray_traced, samples=count), **_BY_RAYS)


def _smoothed(count: int) -> SoftMethod:
    label = f"{_rays(count).label}, SVGF-like"
    constants = {"sigma_luminance": (2.0, 4.0, 8.0)}
    return SoftMethod(label, partial(svgf_denoised, samples=count), constants, **_BY_RAYS)


def _denoised(count: int) -> SoftMethod:
    label = f"{_rays(count).label}, OIDN"
    return SoftMethod(label, partial(oidn_denoised, samples=count), **_BY_RAYS)


# By channel of the buffers.
BASES = {"hard": "Base: hard", "pcf": "Base: PCF 2 × 2", "msm": "Base: MSM 3 × 3, σ 0.55"}


def _held(channel: str, label: str) -> SoftMethod:
    return SoftMethod(label, None, texel_floats=0, of_radius=False, channel=channel)


METHODS: dict[str, SoftMethod] = {
    "no_shadow": null("No shadow", 1.0),
    "all_dark": null("All dark", 0.0),
    # Filters of a map's depths.
    "hard": HARD,
    **{f"pcf_{size}": box_pcf(size) for size in (3, 5, 9, 15)},
    "pcf_disc": DISC_PCF,
    "pcss": PCSS,
    "pcss_post": PCSS_POST,
    # Filtered moments.
    "vsm_3": vsm(3),
    "vsm_9": vsm(9),
    "evsm_9": evsm(9),
    "msm_3": msm(3),
    "msm_9": msm(9),
    "msm_15": msm(15, sigma=3.0),
    # Rays to the light's points, raw and denoised.
    **{f"rt_{count}": _rays(count) for count in (1, 2, 4, 8, 16, 32, 64)},
    **{f"rt_{count}_svgf": _smoothed(count) for count in (1, 4, 16)},
    **{f"rt_{count}_oidn": _denoised(count) for count in (1, 4, 16)},
    # What networks begin with, as a frame's buffers hold it, a user's own frames' too.
    **{f"base_{name}": _held(name, label) for name, label in BASES.items()},
}
