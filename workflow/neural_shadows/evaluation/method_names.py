"""Keys of methods: a network's is its experiment's name, the others' are made here."""

import re

RAY_TRACED = "ray_traced"
SHADOW_MAP_PREFIX = "shadow_map_"
BIASED_SUFFIX = "_biased"
LARGEST_MAP = 32768  # texels along a side: the thesis's reference [4.1]


def shadow_map_key(resolution: int) -> str:
    """Key of the shadow map of resolution² texels."""
    return f"{SHADOW_MAP_PREFIX}{resolution}"


def is_shadow_map(method: str) -> bool:
    """Whether a method's key is `shadow_map_N` of a size that can be rendered."""
    key = re.fullmatch(rf"{SHADOW_MAP_PREFIX}([1-9]\d{{0,4}})", method)
    return key is not None and 2 <= int(key[1]) <= LARGEST_MAP


def resolution_of(method: str) -> int:
    """N of the key `shadow_map_N`."""
    return int(method.removeprefix(SHADOW_MAP_PREFIX))


def biased_key(experiment: str) -> str:
    """Key of a network with the depth bias that was found for it on held-out views."""
    return f"{experiment}{BIASED_SUFFIX}"


def experiment_of(method: str) -> str:
    """The experiment whose network a method's key names."""
    return method.removesuffix(BIASED_SUFFIX)
