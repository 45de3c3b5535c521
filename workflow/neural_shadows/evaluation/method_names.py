"""Keys of methods: a network's is its experiment's name, the others' are made here."""

from dataclasses import dataclass

RAY_TRACED = "ray_traced"
BIASED_SUFFIX = "_biased"

# Null predictors and their labels: what knows nothing of the object, so that what is no better
# than it has learned nothing of it either.
NO_SHADOW = "no_shadow"  # everything that faces the light is lit
NULL = {NO_SHADOW: "No shadow", "all_dark": "All dark"}


@dataclass(frozen=True)
class MapFamily:
    """Shadow maps of one kind: FAMILY_N has N² texels."""

    label: str
    pcf: bool = False  # 2 × 2 depth tests weighted bilinearly, or that of the nearest texel
    sixteen_bit: bool = False  # heights as unorm16, or as float32

    @property
    def texel_bytes(self) -> int:
        """Of a stored height."""
        return 2 if self.sixteen_bit else 4


CLASSIC = {
    "shadow_map": MapFamily("{}² shadow map"),
    "shadow_map_16bit": MapFamily("{}² shadow map, 16 bit", sixteen_bit=True),
    "shadow_map_pcf": MapFamily("{}² shadow map, 2 × 2 PCF", pcf=True),
    "shadow_map_pcf_16bit": MapFamily(
        "{}² shadow map, 2 × 2 PCF, 16 bit", pcf=True, sixteen_bit=True
    ),
}
LARGEST_MAP = 32768  # texels along a side: the thesis's reference [4.1]


def shadow_map_key(resolution: int) -> str:
    """Key of the thesis's shadow map of resolution² texels."""
    return f"shadow_map_{resolution}"


def is_null(method: str) -> bool:
    """Whether a key is a null predictor's."""
    return method in NULL


def is_map(method: str) -> bool:
    """Whether a key, without a bias, is a family of `CLASSIC` and a size that can be rendered."""
    family, _, size = method.rpartition("_")
    return family in CLASSIC and size.isdecimal() and 2 <= int(size) <= LARGEST_MAP


def is_classic(method: str) -> bool:
    """Whether a key, without a bias, is of a method that needs no network and may err."""
    return is_null(method) or is_map(method)


def classic_label(method: str) -> str:
    """What tables call a method of which `is_classic` holds."""
    if is_null(method):
        return NULL[method]
    return family_of(method).label.format(resolution_of(method))


def family_of(method: str) -> MapFamily:
    """The kind of map of a key FAMILY_N."""
    return CLASSIC[method.rpartition("_")[0]]


def resolution_of(method: str) -> int:
    """N of a key FAMILY_N."""
    return int(method.rpartition("_")[2])


def biased_key(method: str) -> str:
    """Key of a method with the depth bias that was found for it on held-out views."""
    return f"{method}{BIASED_SUFFIX}"


def unbiased(method: str) -> str:
    """The key of a method without such a bias: of a network, its experiment's name."""
    return method.removesuffix(BIASED_SUFFIX)
