"""Input features of screen-space networks and their channel counts."""

from collections.abc import Sequence

from neural_shadows.errors import InputError

# Datta et al. 2022 (3.1, 3.2), 15 in all: cosine with the direction to the light, and the light's
# size; cosine with the direction to the eye over the distance from it; shadow map's depth over the
# point's distance from the light, and their difference; cosine between the point's normal and the
# map's; depth along the camera's axis; normal; the map's depth and normal; distance from the light;
# cosine with the direction to the eye.
NSM_FEATURES = {
    **{"c_e": 1, "view": 1, "ratio": 1, "difference": 1, "agreement": 1, "d": 1},
    **{"n": 3, "z": 1, "n_e": 3, "z_f": 1, "c_c": 1},
}
# Base shadows of kernel-predicting networks: by the map's texel, by 2 × 2 of them, by moments, and by a
# few rays a pixel.
BASES = ("base_hard", "base_pcf", "base_msm", "base_rays")
GUIDE = "log_d"  # the feature by which kernels keep to a surface
# Hu et al. 2025 (4.1; z is the former's `z_f`): cosine with the direction to the light, of either sign; that
# with the direction to the eye over the distance from it; width of the penumbra in the frame, the same
# without regard to slant; distance behind the blocker, its distance from the light over the point's
# and alone; the light's radius. Ours: the penumbra's width in the frame by the blockers of a few rays;
# the logarithm of the distance from the eye.
KPNSM_FEATURES = dict.fromkeys(
    (
        *("cosine", "c_v_by_d", "penumbra", "penumbra_pcss", "behind", "z_b_by_z", "z_b", "r_e"),
        *("ray_penumbra", GUIDE),
        *BASES,
    ),
    1,
)
FEATURES = NSM_FEATURES | KPNSM_FEATURES

# The buffers of each: of Neural Shadow Mapping's, in its symbols, view is c_c / d, ratio z / z_f,
# difference z − z_f, and agreement n · n_e.
_BLOCKED = ("z", "gap", "hard")
BUFFERS = {
    "c_e": ("c_e",),
    "view": ("c_v", "d"),
    "ratio": ("z", "gap"),
    "difference": ("gap",),
    "agreement": ("agreement",),
    "d": ("d",),
    "n": ("n_x", "n_y", "n_z"),
    "z": ("z", "gap"),
    "n_e": ("e_x", "e_y", "e_z"),
    "z_f": ("z",),
    "c_c": ("c_v",),
    "cosine": ("c_e",),
    "c_v_by_d": ("c_v", "d"),
    "penumbra": (*_BLOCKED, "d", "c_e", "c_v"),
    "penumbra_pcss": (*_BLOCKED, "d"),
    "behind": _BLOCKED,
    "z_b_by_z": _BLOCKED,
    "z_b": _BLOCKED,
    "r_e": ("z",),
    "ray_penumbra": ("ray_penumbra", "d", "c_e", "c_v"),
    GUIDE: ("d",),
    **{name: (name.removeprefix("base_"),) for name in BASES},
}


TRACED = ("rays", "ray_penumbra")
"""Buffers of one light, by rays: see `ray_tracing.traced_images`."""


def buffers_of(features: Sequence[str]) -> list[str]:
    """List the buffers of features, each once.

    Raises:
        InputError: there is no such feature.
    """
    for name in features:
        if name not in FEATURES:
            raise InputError(f"{name!r} is not a feature. Use {', '.join(FEATURES)}.")
    return list(dict.fromkeys(buffer for name in features for buffer in BUFFERS[name]))


def channels_of(features: Sequence[str]) -> int:
    """Total number of channels of features."""
    return sum(FEATURES[name] for name in features)


def base_of(features: Sequence[str]) -> str:
    """Find the base feature of a kernel-predicting network.

    Raises:
        ValueError: there is none, or more than one.
    """
    bases = [name for name in features if name in BASES]
    if len(bases) != 1:
        raise ValueError(
            f"kernels filter one of the features {', '.join(BASES)}; there is "
            f"{' and '.join(bases) or 'none'}"
        )
    return bases[0]
