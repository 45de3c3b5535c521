"""All methods for soft shadows by their keys; their names are in `soft_method_names.py`.

A module of this folder has the methods of a family as `METHODS`, by key. It is imported by the
key, so that a result depends on the modules of its own methods alone, as networks do on their kind's.
Any other key is that of a trained network, which its file of weights tells.
"""

from collections.abc import Callable, Iterable, Sequence
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

from neural_shadows.evaluation.soft_method_names import asks_fields, denoiser_of, is_network

if TYPE_CHECKING:  # the graph asks for modules alone
    from neural_shadows.evaluation.soft_methods.soft_method import SoftMethod

# Of a family, which is a key's first word; any other's module is called as the family is.
_MODULES = {
    "no": "nothing_known",
    "all": "nothing_known",
    "hard": "hard_map",
    "rt": "ray_traced",
    "field": "object_fields",
    "cone": "object_cones",
    "base": "base_shadows",
}

_FIELDS = "neural_shadows.evaluation.soft_methods.object_fields"
_NETWORK = "neural_shadows.evaluation.soft_methods.screen_network"


def method_module(key: str) -> Path:
    """The module of a method: `pcf.py` for `pcf_9`."""
    if is_network(key):
        return Path(__file__).with_name("screen_network.py")
    family = key.partition("_")[0]
    name = "denoised" if denoiser_of(key) else _MODULES.get(family, family)
    return Path(__file__).with_name(f"{name}.py")


def soft_method(key: str, weights: Path | None = None, precision: str = "auto") -> "SoftMethod":
    """The method of a key, if it is a network, with its weights, in a number format."""
    module = import_module(f"neural_shadows.evaluation.soft_methods.{method_module(key).stem}")
    return module.screen_method(weights, precision) if is_network(key) else module.METHODS[key]


def take_fields(keys: Iterable[str], paths: Iterable[Path]) -> None:
    """Let those of some methods that ask fields take them from files of `fit_fields`.

    Raises:
        InputError: a file is missing or damaged.
    """
    if any(map(asks_fields, keys)):
        import_module(_FIELDS).take_stored(paths)


def soft_methods_by_scene(
    key: str, weights: Sequence[Path] = (), precision: str = "auto", by_scene: bool = False
) -> "Callable[[str], SoftMethod | None]":
    """The method of a key, by scene; `by_scene`: of the networks the one that learned it, or None.

    None of all scenes for a network in a number format that the CPU would have to emulate.
    """
    network = import_module(_NETWORK) if is_network(key) else None
    if network and not network.computes_in(precision):
        return lambda scene: None
    if not by_scene:
        method = soft_method(key, *weights, precision=precision)
        return lambda scene: method
    return {
        scene: network.screen_method(path, precision)
        for path in weights
        for scene in network.learned_scenes(path)
    }.get
