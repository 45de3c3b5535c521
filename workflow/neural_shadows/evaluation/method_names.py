"""Keys of hard-shadow methods: experiments' names, and `hard_methods`.

Each module of that folder is a family, `METHODS` by key, or by FAMILY for keys FAMILY_N. None is
imported by a statement, as families of `soft_registry`.
"""

from collections.abc import Iterable
from pathlib import Path

from neural_shadows.evaluation.hard_method import HardMethod
from neural_shadows.settings.kinds import kinds

RAY_TRACED = "ray_traced"
BIASED_SUFFIX = "_biased"

_FAMILIES = {
    key: family for family in kinds("evaluation/hard_methods").values() for key in family.METHODS
}
METHODS: dict[str, HardMethod] = {key: family.METHODS[key] for key, family in _FAMILIES.items()}
PATTERNS = [
    *(f"{key}_N" for key, method in METHODS.items() if method.sizes),
    *(key for key, method in METHODS.items() if not method.sizes),
]


def shadow_map_key(resolution: int) -> str:
    """Key of the thesis's shadow map of resolution² texels."""
    return f"shadow_map_{resolution}"


# By the config's word: shadow rays, or the thesis's map of 32768² texels [4.1].
REFERENCES = {"exact": RAY_TRACED, "shadow_map": shadow_map_key(32768)}


def family_and_size(method: str) -> tuple[str | None, int]:
    """Key in `METHODS` of an unbiased method, and its N. N is 0 without one.

    The key is None of a network, of ray tracing, and of a size that cannot be rendered.
    """
    family, _, size = method.rpartition("_")
    if family in METHODS and size.isdecimal() and int(size) in METHODS[family].sizes:
        return family, int(size)
    return (method if method in METHODS and not METHODS[method].sizes else None), 0


def is_classic(method: str) -> bool:
    """Check for a key, without bias, of an inexact classic method."""
    return family_and_size(method)[0] is not None


def classic_label(method: str) -> str:
    """Label in tables of a method with `is_classic`."""
    family, size = family_and_size(method)
    return METHODS[family].label.format(size)


def hard_modules(methods: Iterable[str]) -> set[Path]:
    """Modules of the methods' families; keys may have a bias."""
    families = {family_and_size(unbiased(method))[0] for method in methods} - {None}
    return {Path(_FAMILIES[family].__file__) for family in families}


def biased_key(method: str) -> str:
    """Key of a method with a depth bias from held-out views."""
    return f"{method}{BIASED_SUFFIX}"


def unbiased(method: str) -> str:
    """Key of a method without bias: of a network, its experiment's."""
    return method.removesuffix(BIASED_SUFFIX)
