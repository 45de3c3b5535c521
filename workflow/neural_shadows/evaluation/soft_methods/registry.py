"""All methods for soft shadows by their keys; their names are in `soft_method_names.py`."""

from functools import partial

from neural_shadows.evaluation.soft_method_names import (
    BASE,
    BASES,
    BOXES,
    DENOISED_RAYS,
    FIELD_RAYS,
    OIDN,
    RAYS,
)
from neural_shadows.evaluation.soft_methods.denoised import (
    oidn_denoised,
    svgf_denoised,
    svgf_sequence,
)
from neural_shadows.evaluation.soft_methods.evsm import evsm
from neural_shadows.evaluation.soft_methods.hard_map import HARD
from neural_shadows.evaluation.soft_methods.msm import msm
from neural_shadows.evaluation.soft_methods.object_fields import field_bytes, field_traced
from neural_shadows.evaluation.soft_methods.pcf import DISC_PCF, box_pcf
from neural_shadows.evaluation.soft_methods.pcss import PCSS, PCSS_POST
from neural_shadows.evaluation.soft_methods.ray_traced import ray_traced
from neural_shadows.evaluation.soft_methods.soft_method import SoftMethod
from neural_shadows.evaluation.soft_methods.vsm import vsm

_BY_RAYS = {"texel_floats": 0, "by_rays": True}
CELLS = (0.5, 1.0, 2.0, 4.0)
_HELD = {"texel_floats": 0, "of_radius": False}


def _smoothed(samples: int) -> SoftMethod:
    answer, sequence = (partial(one, samples=samples) for one in (svgf_denoised, svgf_sequence))
    constants = {"sigma_luminance": (2.0, 4.0, 8.0)}
    return SoftMethod(answer, constants, sequence=sequence, **_BY_RAYS)


METHODS: dict[str, SoftMethod] = {
    "no_shadow": SoftMethod(constant=1.0, **_HELD),
    "all_dark": SoftMethod(constant=0.0, **_HELD),
    # Filters of a map's depths.
    "hard": HARD,
    **{f"pcf_{size}": box_pcf(size) for size in BOXES},
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
    **{f"rt_{n}": SoftMethod(partial(ray_traced, samples=n), **_BY_RAYS) for n in RAYS},
    **{f"rt_{n}_svgf": _smoothed(n) for n in DENOISED_RAYS},
    **{
        f"rt_{n}{OIDN}": SoftMethod(partial(oidn_denoised, samples=n), **_BY_RAYS)
        for n in DENOISED_RAYS
    },
    # The same through occupancy fields in place of the objects.
    **{
        f"field_{n}": SoftMethod(
            partial(field_traced, samples=n), {"cells": CELLS}, held=field_bytes, **_BY_RAYS
        )
        for n in FIELD_RAYS
    },
    # What networks begin with, as a frame's buffers hold it, a user's own frames' too.
    **{f"{BASE}{name}": SoftMethod(channel=name, **_HELD) for name in BASES},
}
