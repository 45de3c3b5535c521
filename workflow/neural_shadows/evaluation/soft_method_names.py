"""Keys and names of the methods for soft shadows; what each does is in `soft_methods`.

Apart from that, so that the configuration and the graph need not wait for what computes.
"""

from importlib.util import find_spec

NULL = {"no_shadow": "No shadow", "all_dark": "All dark"}
UNLEARNED = (*NULL, "hard")  # what a network must be better than: they learn nothing
BOXES = (3, 5, 9, 15)  # texels of a side
RAYS = (1, 2, 3, 4, 6, 8, 16, 32, 40, 64)  # of a pixel
SPREAD_RAYS = (2, 4, 8)  # over as many places of a pixel
# By what a key of denoised rays ends with: what the denoiser is called, and rays of a pixel.
DENOISERS = {
    "svgf": ("SVGF-like", (1, 2, 4, 16, 30)),
    "ffx": ("FFX-like", (1, 2, 4)),
    "sigma": ("SIGMA-like", (1, 2, 4)),
    "sigma_ffx": ("SIGMA- and FFX-like", (1, 2, 4)),
    "oidn_fast": ("OIDN fast", (1, 2, 4)),
    "oidn": ("OIDN", (1, 2, 4, 16, 30)),
}
FIELD_RAYS = (1, 4, 16)  # through occupancy fields
CONE_WALKS = (1, 4, 8)  # through them, of what neither sees all of the light nor none
# By channel of a frame's buffers.
BASES = {"hard": "Base: hard", "pcf": "Base: PCF 2 × 2", "msm": "Base: MSM 3 × 3, σ 0.55"}
BASE = "base_"
EXACT = "exact_centre"
SPREAD = "_spread"
OIDN = ("oidn", "oidn_fast")  # of the denoisers, those of a package of its own
FORMATS = ("float32", "bfloat16")
# How far a field's rays start from what they leave does not depend on their number: to choose it anew
# took 98 s of a core.
_TUNED_AS = {
    "field_4": "field_1",
    "field_16": "field_1",
    "cone_4": "cone_1",
    "cone_8": "cone_1",
}


def _rays(count: int) -> str:
    return f"{count} ray{'s' if count > 1 else ''}"


# By key, in the order of tables.
LABELS = {
    **NULL,
    EXACT: "Exact at the pixel's centre",
    "hard": "Shadow map",
    **{f"pcf_{size}": f"PCF {size} × {size}" for size in BOXES},
    "pcf_disc": "PCF, disc",
    "pcss": "PCSS",
    "pcss_post": "PCSS, depth-aware filter",
    "pcss_2048": "PCSS, map of 2048²",
    "pcss_2048_post": "PCSS, map of 2048², depth-aware filter",
    "vsm_3": "VSM 3 × 3",
    "vsm_9": "VSM 9 × 9",
    "evsm_9": "EVSM 9 × 9",
    "msm_3": "MSM 3 × 3",
    "msm_9": "MSM 9 × 9",
    "msm_15": "MSM 15 × 15, σ 3",
    **{f"rt_{count}": _rays(count) for count in RAYS},
    **{f"rt_{count}{SPREAD}": f"{_rays(count)}, spread" for count in SPREAD_RAYS},
    **{
        f"rt_{count}_{key}": f"{_rays(count)}, {label}"
        for key, (label, counts) in DENOISERS.items()
        for count in counts
    },
    **{f"field_{count}": f"{_rays(count)}, fields" for count in FIELD_RAYS},
    "cone_1": "One walk, fields",
    **{f"cone_{walks}": f"One walk split in {walks}, fields" for walks in CONE_WALKS[1:]},
    **{f"{BASE}{name}": label for name, label in BASES.items()},
}


def rays_of(method: str) -> int | None:
    """How many rays of a pixel a method sends that does nothing else; None for another."""
    count = method.removeprefix("rt_")
    return int(count) if count != method and count.isdecimal() else None


def denoiser_of(method: str) -> str | None:
    """The key in `DENOISERS` of what smooths a method's rays; None of another method."""
    first, *rest = method.split("_", 2)
    return rest[1] if first == "rt" and len(rest) == 2 and rest[1] in DENOISERS else None


def is_network(method: str) -> bool:
    """Whether a method is a trained network: an experiment of `screen_experiments`."""
    return method not in LABELS


def in_format(experiment: str, precision: str) -> str:
    """The method that a trained network is in one of `FORMATS`; its name alone is it in the one that
    the machine multiplies fastest.
    """
    return f"{experiment}_{precision}"


def is_tuned(method: str) -> bool:
    """Whether a method has constants, which are chosen on validation frames."""
    constant = method in (*NULL, EXACT, "hard") or method.startswith(BASE) or is_network(method)
    untuned = rays_of(method) is not None or method.endswith(SPREAD) or denoiser_of(method) in OIDN
    return not constant and not untuned


def asks_fields(method: str) -> bool:
    """Whether a method asks fields that are fitted to a scene's objects."""
    return method.startswith(("field_", "cone_"))


def tuned_as(method: str) -> str:
    """The method whose constants a method has: itself, but for a few."""
    return _TUNED_AS.get(method, method)


def available(method: str) -> bool:
    """Whether a method can be had on this machine: Open Image Denoise is for x86-64 alone."""
    return denoiser_of(method) not in OIDN or find_spec("pyoidn") is not None
