"""Stage: occluders of test frames, by depth and penumbra width."""

from pathlib import Path

import numpy as np

from neural_shadows.evaluation.measured_frames import MeasuredFrame, measured_frames
from neural_shadows.files.arrays import new_array, open_array
from neural_shadows.frames.frame_set import FrameSetPart
from neural_shadows.frames.penumbra_widths import model_widths
from neural_shadows.metrics.visibility_error import LIT, UMBRA
from neural_shadows.rendering.blockers import solids_before
from neural_shadows.running.progress import progress_bar
from neural_shadows.running.stage import run_stage


def measure_occluders(
    parts: list[Path], meshes: list[Path], occluders_npy: Path, *, threads: int = 1
) -> None:
    """Write solids before the light and penumbra width, by frame.

    Solids before the light's centre, and the width of the largest light's penumbra in pixels, (F,
    2, H, W) float16; 0 without a surface, the latter also where no light has a penumbra.

    Args:
        parts: one part of a frame set. meshes: see `measured_frames`.

    Raises:
        InputError: a file is damaged.
    """
    (part,) = map(FrameSetPart, parts)
    shape = (len(part), 2, part.about["height"], part.about["width"])
    with (
        new_array(occluders_npy, shape, np.float16) as occluders,
        progress_bar(len(part), "frames", "occluders") as bar,
    ):
        for measured in measured_frames(parts, meshes):
            occluders[measured.number] = _occluders(measured)
            bar.update()


def read_occluders(path: Path) -> np.ndarray:
    """Read a file of `measure_occluders`.

    Raises:
        InputError: the file is missing or damaged.
    """
    return open_array(path, (None, 2, None, None), np.float16)


def _occluders(measured: MeasuredFrame) -> np.ndarray:
    frame, surface = measured.frame, measured.frame.surface
    solids = solids_before(frame.scene, surface, frame.centre)
    focal, radius = surface.camera.focal(surface.height), max(measured.part.radii)
    # Widths are used nowhere else, and sixteen directions a point are most of the work.
    penumbra = ((measured.target >= UMBRA) & (measured.target <= LIT)).any(0)
    selected = np.flatnonzero(penumbra.ravel()[surface.pixel])
    widths = np.zeros(len(surface.p))
    widths[selected] = model_widths(frame.scene, surface, frame.centre, radius, focal, selected)
    most = np.finfo(np.float16).max
    return np.stack(
        [surface.image(values.clip(0, most)) for values in (np.float32(solids), widths)]
    )


if "snakemake" in globals():
    run_stage(snakemake, measure_occluders)
