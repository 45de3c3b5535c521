"""Stage: times of a table's methods, on one thread."""

from collections.abc import Mapping
from pathlib import Path

from neural_shadows.evaluation.frame import TIMES, Inputs, module_of
from neural_shadows.files.whole_files import write_json
from neural_shadows.running.one_thread import one_thread
from neural_shadows.running.origin import describe_origin
from neural_shadows.running.stage import run_stage
from neural_shadows.settings.records import FrameTimesSettings, SceneSettings, ViewSettings


def time_methods(
    frames: list[Path],
    meshes: list[Path],
    constants: list[Path],
    weights: list[Path],
    fields: list[Path],
    times_json: Path,
    *,
    methods: Mapping[str, str | None],
    scene: SceneSettings | None = None,
    views: ViewSettings | None = None,
    frame_times: FrameTimesSettings | None = None,
    repeats: int = 3,
    device: str = "auto",
    precision: str = "auto",
) -> None:
    """Time methods in turn on the same frames.

    Args:
        frames: test frames, one part a scene; none for views, which are rendered.
        meshes, weights, fields, scene, device, precision: see `Inputs`; weights are in folders of their
            experiments' names.
        constants: of `tune`, of the tuned methods.
        times_json: see `time_views.times` and `time_frames.times`.
        methods: the experiment of each one's weights, or None.
        views: of the scene; frame_times: `width`, `height` (pixels) and `repeats`, timed frames of
            each method.

    Raises:
        InputError: an input file cannot be read, or a setting does not fit the scene.
    """
    inputs = Inputs(
        frames, meshes, weights, fields=fields, scene=scene, device=device, precision=precision
    )
    of_kind = (views, frame_times) if views else (constants, repeats)
    with one_thread():
        times = module_of(TIMES, bool(views)).times(inputs, methods, *of_kind)
    write_json(times_json, times | describe_origin())


if "snakemake" in globals():
    run_stage(snakemake, time_methods)
