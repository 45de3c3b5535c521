"""Stage: distance fields of a frame set's objects, for all methods."""

from pathlib import Path

from neural_shadows.evaluation.measured_frames import measured_frames
from neural_shadows.evaluation.method_parts.object_field import write_fields
from neural_shadows.evaluation.method_parts.scene_fields import fields_in
from neural_shadows.frames.frame_set import FrameSetPart
from neural_shadows.representations.shadow_field.shadow_field import ShadowField
from neural_shadows.running.progress import progress_bar
from neural_shadows.running.stage import run_stage


def fit_fields(parts: list[Path], meshes: list[Path], fields_npz: Path) -> None:
    """Fit and write a field of each closed object.

    Fields are fitted wherever an object stands in a frame.

    Args:
        parts: of test, validation and sequence frames. meshes: see `measured_frames`.
        fields_npz: see `write_fields`.

    Raises:
        InputError: an input file cannot be read.
    """
    fields: dict[str, ShadowField] = {}
    total = sum(len(FrameSetPart(path)) for path in parts)
    with progress_bar(total, "frames", "fit fields") as bar:
        for measured in measured_frames(parts, meshes):
            motion = measured.part.setting(measured.number).motion
            fields |= fields_in(measured.scene.moved(motion))
            bar.update()
    write_fields(fields_npz, fields)


if "snakemake" in globals():
    run_stage(snakemake, fit_fields)
