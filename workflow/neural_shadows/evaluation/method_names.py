"""Keys of methods: a network's is its experiment's name, the others' are made here."""

RAY_TRACED = "ray_traced"
BIASED_SUFFIX = "_biased"

# Methods that need no training, and their labels: FAMILY_N has a map of N² texels.
CLASSIC = {"shadow_map": "{}² shadow map"}
LARGEST_MAP = 32768  # texels along a side: the thesis's reference [4.1]


def shadow_map_key(resolution: int) -> str:
    """Key of the shadow map of resolution² texels."""
    return f"shadow_map_{resolution}"


def is_classic(method: str) -> bool:
    """Whether a method's key is a family of `CLASSIC` and a size that can be rendered."""
    family, _, size = method.rpartition("_")
    return family in CLASSIC and size.isdecimal() and 2 <= int(size) <= LARGEST_MAP


def classic_label(method: str) -> str:
    """What tables call a method of `CLASSIC`."""
    return CLASSIC[method.rpartition("_")[0]].format(resolution_of(method))


def resolution_of(method: str) -> int:
    """N of the key `shadow_map_N`."""
    return int(method.rpartition("_")[2])


def biased_key(experiment: str) -> str:
    """Key of a network with the depth bias that was found for it on held-out views."""
    return f"{experiment}{BIASED_SUFFIX}"


def experiment_of(method: str) -> str:
    """The experiment whose network a method's key names."""
    return method.removesuffix(BIASED_SUFFIX)
