"""Methods on frames and stages on few files, for tests."""

from collections.abc import Sequence
from itertools import product
from pathlib import Path
from types import SimpleNamespace

from neural_shadows.evaluation.evaluate import evaluate
from neural_shadows.evaluation.method import Method
from neural_shadows.evaluation.registry import METHODS
from neural_shadows.evaluation.screen_network_method import screen_method
from neural_shadows.files.whole_files import write_json
from neural_shadows.running.stage import arguments_of


def frame_method(key: str, weights: Path | None = None, precision: str = "auto") -> Method:
    """The method of a key on frames; a network with weights and format."""
    return screen_method(weights, precision) if weights else METHODS[key]


def settings_of(method: Method) -> list[dict[str, float]]:
    """All combinations of a method's constants."""
    return [dict(zip(method.constants, values)) for values in product(*method.constants.values())]


def evaluate_frames(
    frames: Sequence[Path],
    lpips_json: Path,
    outputs: tuple[Path, Path],
    *,
    sequences: Sequence[Path] = (),
    meshes: Sequence[Path] = (),
    weights: Sequence[Path] = (),
    constants: Path | None = None,
    **settings,
) -> None:
    """Call `evaluate`; `outputs` are metrics and visibilities."""
    inputs = [*frames], [*sequences], [*meshes], [*weights], constants, lpips_json
    evaluate(*inputs, *outputs, **settings)


def called(function, **job):
    """A stage's function with what a job hands to it."""
    parts = dict.fromkeys(("input", "output", "params", "wildcards"), {})
    return function(
        **arguments_of(SimpleNamespace(threads=1, resources={}, **parts | job), function)
    )


def write_constants(path: Path, **constants: float) -> Path:
    """Write constants as `tune` does, of one radius."""
    write_json(path, {"radii": [{"constants": constants, "at_end": []}]})
    return path
