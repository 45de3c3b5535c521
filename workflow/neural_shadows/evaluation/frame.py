"""Frames of either kind, for tuning and evaluation.

A frame is a view of a scene in its unit sphere under a sun (`views`), or an image of a scene in metres
under an area light of several radii (`measured_frames`). Both modules have the same
functions, and frames of the same methods: `errors_of` returns sums of errors by radius (settings, terms
of `ERRORS`), and their divisor. The modules of metrics have `metrics`, of a frame, a method's visibility, a
radius by number and image metrics by name. None is imported by a statement, so that a result depends on
its own kind's alone.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from types import ModuleType

from neural_shadows.evaluation.method import Constants
from neural_shadows.files.whole_files import read_json
from neural_shadows.settings.records import SceneSettings

# Modules of views and of frames: themselves, their metrics, their times.
KIND = "views", "measured_frames"
METRICS = "view_metrics", "frame_metrics"
TIMES = "time_views", "time_frames"
OF_SEQUENCES = "sequences"  # a view has none


@dataclass(frozen=True)
class Inputs:
    """Files and settings of frames and a method.

    Args:
        frames: `References`, or parts of a frame set. sequences: parts of consecutive frames.
        meshes: prepared: of the scene in its sphere, or of all inserted objects, in folders of their
            names.
        weights: of a network, or of one for each scene.
        fields: of `fit_fields`, for a method that needs them.
        occluders: of `measure_frames`, over all test frames; None for no errors by occluder.
        scene: `up`, `ground` and `light` of a scene in its sphere, see `open_scene`.
        device, precision: of a network, see `choose_device` and `choose_dtype`.
        by_scene: evaluate each of the networks of `weights` on its training scenes alone.
    """

    frames: Sequence[Path]
    meshes: Sequence[Path] = ()
    weights: Sequence[Path] = ()
    sequences: Sequence[Path] = ()
    fields: Sequence[Path] = ()
    occluders: Path | None = None
    scene: SceneSettings | None = None
    device: str = "auto"
    precision: str = "auto"
    threads: int = 1
    by_scene: bool = False


def module_of(names: tuple[str, str], views: bool) -> ModuleType:
    """One of `KIND`, `METRICS` or `TIMES`."""
    return import_module(f"{__package__}.{names[not views]}")


def sequences_module() -> ModuleType:
    """The module of answers to sequences of frames."""
    return import_module(f"{__package__}.{OF_SEQUENCES}")


def module_file(name: str) -> Path:
    """File of a module imported by name."""
    return Path(__file__).with_name(f"{name}.py")


def are_views(frames: Sequence[Path]) -> bool:
    """Check for files of views."""
    return frames[0].suffix == ".safetensors"


def constants_of(path: Path | None, radii: int = 1) -> list[Constants]:
    """Constants by radius, of `tune`; empty without a path."""
    return [each["constants"] for each in read_json(path)["radii"]] if path else [{}] * radii


def sequence_constants_of(path: Path | None, radii: int) -> list[Constants]:
    """Constants by radius for sequences: those chosen with a history, if any were."""
    history = read_json(path).get("history") if path else None
    return [history["constants"]] * radii if history else constants_of(path, radii)
