"""All soft-shadow methods by key, from the families in `soft_methods`.

Each module of that folder is a family: `METHODS` by key, and `LOOK`, for those without their own.
None is imported by a statement, and none imports its computing modules before it runs: a result
depends on its own method's module alone, which rules name by `method_module`, and the graph waits
for none. Any other key is that of a trained network, whose file of weights it needs.
"""

from collections.abc import Callable, Iterable, Sequence
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path

from neural_shadows.evaluation.look import BLACK, Look
from neural_shadows.evaluation.null_predictors import NULL
from neural_shadows.evaluation.soft_method import SoftMethod
from neural_shadows.settings.kinds import kinds

_FIELDS = "neural_shadows.evaluation.method_parts.scene_fields"
_NETWORK = "neural_shadows.evaluation.screen_network_method"
NETWORK_LOOK = Look(
    "screen-space networks",
    BLACK,
    "*",
    "★",
    "Answers a whole frame from its buffers and the light's map.",
)
FORMATS = ("float32", "bfloat16")  # of networks in evaluation

_FAMILIES = {
    key: family for family in kinds("evaluation/soft_methods").values() for key in family.METHODS
}
METHODS: dict[str, SoftMethod] = {key: family.METHODS[key] for key, family in _FAMILIES.items()}
LABELS = {key: method.label for key, method in METHODS.items()}
UNLEARNED = (*NULL, *(key for key, method in METHODS.items() if method.null and key not in NULL))


def is_network(method: str) -> bool:
    """Check for a trained network, of `screen_experiments`."""
    return method not in METHODS


def in_format(experiment: str, precision: str) -> str:
    """Key of a trained network in one of `FORMATS`.

    Its name alone is in the format that the machine multiplies fastest.
    """
    return f"{experiment}_{precision}"


def look_of(method: str) -> Look:
    """The look of a method, its own or its family's."""
    return NETWORK_LOOK if is_network(method) else METHODS[method].look or _FAMILIES[method].LOOK


def is_tuned(method: str) -> bool:
    """Check for constants chosen on validation frames."""
    return not is_network(method) and bool(METHODS[method].constants)


def tuned_as(method: str) -> str:
    """Key of a method's constants: mostly its own."""
    return method if is_network(method) else METHODS[method].tuned_as or method


def needs_fields(method: str) -> bool:
    """Check for the need of fields fitted to a scene's objects."""
    return not is_network(method) and METHODS[method].fields


def needs_scene(method: str) -> bool:
    """Check for the need of more than a frame's buffers."""
    return not is_network(method) and METHODS[method].answer is not None


def rays_of(method: str) -> int | None:
    """Rays a pixel of a plain ray tracer; None for others."""
    return None if is_network(method) else METHODS[method].rays


def available(method: str) -> bool:
    """Check for the package of a method, if it needs one."""
    package = None if is_network(method) else METHODS[method].package
    return package is None or find_spec(package) is not None


def method_module(key: str) -> Path:
    """The module of a method's family: `pcf.py` for `pcf_9`."""
    if is_network(key):
        return Path(__file__).with_name(f"{_NETWORK.rpartition('.')[2]}.py")
    return Path(_FAMILIES[key].__file__)


def soft_method(key: str, weights: Path | None = None, precision: str = "auto") -> SoftMethod:
    """The method of a key; a network with weights and format."""
    if is_network(key):
        return import_module(_NETWORK).screen_method(weights, precision)
    return METHODS[key]


def take_fields(keys: Iterable[str], paths: Iterable[Path]) -> None:
    """Load fields of `fit_fields` for the methods that need them.

    Raises:
        InputError: a file is missing or damaged.
    """
    if any(map(needs_fields, keys)):
        import_module(_FIELDS).take_stored(paths)


def soft_methods_by_scene(
    key: str, weights: Sequence[Path] = (), precision: str = "auto", by_scene: bool = False
) -> Callable[[str], SoftMethod | None]:
    """The method of a key, by scene.

    `by_scene`: the network trained on the scene, or None.

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
