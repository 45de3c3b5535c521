"""All shadow methods by key, from the families in `methods`.

Each module of that folder is a family: `METHODS` by key, or by FAMILY for keys FAMILY_N, and `LOOK`,
for those without their own. None is imported by a statement, and none imports its computing modules
before it runs: a result depends on its own method's module alone, which rules name by
`method_modules`, and the graph waits for none. Any other key is that of a trained network, whose file
of weights it needs.
"""

from collections.abc import Iterable
from dataclasses import replace
from functools import cache, partial
from importlib.util import find_spec
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING

from neural_shadows.evaluation.look import BLACK, Look
from neural_shadows.evaluation.method import Method, ShadowMethod
from neural_shadows.evaluation.null_predictors import NULL
from neural_shadows.settings.kinds import kinds

if TYPE_CHECKING:  # the graph needs metadata alone
    from neural_shadows.scenes.scene import Scene

RAY_TRACED = "ray_traced"
BIASED_SUFFIX = "_biased"
FORMATS = ("float32", "bfloat16")  # of screen-space networks in evaluation
NETWORK_LOOK = Look(
    "screen-space networks",
    BLACK,
    (4, 1, 0),
    "✦",
    "Answers a whole frame from its buffers and the light's map.",
)


def _families() -> dict[str, ModuleType]:
    """The family of each key.

    Raises:
        ValueError: two have the same.
    """
    families: dict[str, ModuleType] = {}
    for family in kinds("evaluation/methods").values():
        for key in family.METHODS:
            if key in families:
                files = " and ".join(Path(one.__file__).name for one in (families[key], family))
                raise ValueError(f"evaluation/methods: {files} both have {key!r}. Rename one")
            families[key] = family
    return families


_FAMILIES = _families()
METHODS: dict[str, Method] = {key: family.METHODS[key] for key, family in _FAMILIES.items()}
FRAME_METHODS = {key: method for key, method in METHODS.items() if method.answers_frames}
"""Methods of frames under an area light, by key."""
VIEW_METHODS = {
    key: method for key, method in METHODS.items() if method.answers_views and not method.exact
}
"""Methods of views under a sun, by key or family, but their reference."""
PATTERNS = [
    *(f"{key}_N" for key, method in VIEW_METHODS.items() if method.sizes),
    *(key for key, method in VIEW_METHODS.items() if not method.sizes),
]
LABELS = {key: method.label for key, method in METHODS.items() if not method.sizes}
UNLEARNED = (*NULL, *(key for key, method in METHODS.items() if method.null and key not in NULL))


def shadow_map_key(resolution: int) -> str:
    """Key of the thesis's shadow map of resolution² texels."""
    return f"shadow_map_{resolution}"


# By the config's word: shadow rays, or the thesis's map of 32768² texels [4.1].
REFERENCES = {"exact": RAY_TRACED, "shadow_map": shadow_map_key(32768)}


def biased_key(method: str) -> str:
    """Key of a method with a depth bias from held-out views."""
    return f"{method}{BIASED_SUFFIX}"


def unbiased(method: str) -> str:
    """Key of a method without bias: of a network, its experiment's."""
    return method.removesuffix(BIASED_SUFFIX)


def in_format(experiment: str, precision: str) -> str:
    """Key of a screen-space network in one of `FORMATS`.

    Its name alone is in the format that the machine multiplies fastest.
    """
    return f"{experiment}_{precision}"


def family_and_size(method: str) -> tuple[str | None, int]:
    """Key in `METHODS` of an unbiased method, and its N.

    N is 0 without one. The key is None of a network, and of a size that cannot be rendered.
    """
    family, _, size = method.rpartition("_")
    if family in METHODS and size.isdecimal() and int(size) in METHODS[family].sizes:
        return family, int(size)
    return (method if method in METHODS and not METHODS[method].sizes else None), 0


@cache
def method_of(key: str) -> Method:
    """The method of a key without bias.

    Label, bytes and `sun` are those of its size.

    Raises:
        KeyError: it is a network.
    """
    family, size = family_and_size(key)
    if not size:
        return METHODS[family]
    method = METHODS[family]
    stored = method.stored_bytes and partial(method.stored_bytes, size)
    sun = partial(method.sun, size=size)
    return replace(method, label=method.label.format(size), stored_bytes=stored, sun=sun)


def is_network(method: str) -> bool:
    """Check for a trained network; keys may have a bias."""
    return family_and_size(unbiased(method))[0] is None


def is_classic(method: str) -> bool:
    """Check for an inexact method of views without a network.

    Args:
        method: key without bias.
    """
    return family_and_size(method)[0] in VIEW_METHODS


def look_of(method: str) -> Look:
    """Look of a method of frames, or of its family."""
    return NETWORK_LOOK if is_network(method) else family_look(method)


def family_look(family: str) -> Look:
    """The look of a key in `METHODS`."""
    return METHODS[family].look or _FAMILIES[family].LOOK


def frame_method(key: str) -> Method:
    """The method of a key on frames; of a network one without entries."""
    return METHODS.get(key, Method())


def available(method: str) -> bool:
    """Check for the package of a method, if it needs one."""
    package = frame_method(method).package
    return package is None or find_spec(package) is not None


def method_modules(methods: Iterable[str]) -> set[Path]:
    """Modules of methods' families: `pcf.py` for `pcf_9`.

    None of networks. Keys may have a bias.
    """
    families = {family_and_size(unbiased(method))[0] for method in methods} - {None}
    return {Path(_FAMILIES[family].__file__) for family in families}


def classic_method(method: str, scene: "Scene", *, whole_map: bool = False) -> ShadowMethod:
    """A method of views without a network.

    Args:
        method: the key, without a bias.
        whole_map: rasterise each texel of a shadow map, as a renderer does; else only the
            texels of receivers are traced, in a fraction of the time at 2048² and with the same
            values but for rounding.
    """
    record = method_of(method)
    return lambda frame: record.of_view(frame, scene, whole_map=whole_map)
