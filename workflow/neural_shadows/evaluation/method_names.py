"""Keys of methods: a network's is its experiment's name, others' are in `hard_methods`.

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
METHODS: dict[str, HardMethod] = {key: one.METHODS[key] for key, one in _FAMILIES.items()}
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
    """The key in `METHODS` of a method without a bias, and its N, or 0.

    The key is None of a network, of ray tracing, and of a size that cannot be rendered.
    """
    family, _, size = method.rpartition("_")
    if family in METHODS and size.isdecimal() and int(size) in METHODS[family].sizes:
        return family, int(size)
    return (method if method in METHODS and not METHODS[method].sizes else None), 0


def is_classic(method: str) -> bool:
    """Whether a key, without a bias, is of a method that needs no network and may err."""
    return family_and_size(method)[0] is not None


def classic_label(method: str) -> str:
    """What tables call a method of which `is_classic` holds."""
    family, size = family_and_size(method)
    return METHODS[family].label.format(size)


def hard_modules(methods: Iterable[str]) -> set[Path]:
    """The modules of the families of those methods that need no network; keys may have a bias."""
    families = {family_and_size(unbiased(method))[0] for method in methods} - {None}
    return {Path(_FAMILIES[family].__file__) for family in families}


def biased_key(method: str) -> str:
    """Key of a method with the depth bias that was found for it on held-out views."""
    return f"{method}{BIASED_SUFFIX}"


def unbiased(method: str) -> str:
    """The key of a method without such a bias: of a network, its experiment's name."""
    return method.removesuffix(BIASED_SUFFIX)
