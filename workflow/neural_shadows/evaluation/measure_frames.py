"""Stage: a measure of a frame set's test frames."""

from collections import defaultdict
from pathlib import Path

import numpy as np

from neural_shadows.evaluation.measured_frames import MeasuredFrame, measured_frames
from neural_shadows.files.arrays import new_array
from neural_shadows.files.whole_files import write_json
from neural_shadows.frames.frame_set import FrameSetPart
from neural_shadows.frames.penumbra_widths import model_widths
from neural_shadows.metrics.kinds.errors_of_visibility import LIT, UMBRA
from neural_shadows.metrics.kinds.penumbra_width import WIDEST, local_widths
from neural_shadows.rendering.blockers import solids_before
from neural_shadows.running.origin import describe_origin
from neural_shadows.running.progress import progress_bar
from neural_shadows.running.stage import run_stage

PERCENTILES = (50, 90)


def measure_frames(parts: list[Path], meshes: list[Path], output: Path, *, measure: str) -> None:
    """Write one measure of frames with their exact shadows.

    `widths.json`: median and 90th percentile of widths over the penumbra pixels of a scene's frames, in
    pixels, see `local_widths`. By scene, as `scenes`, a pair by radius, None of a light without a
    penumbra; `radii` as they are configured, in `radius_unit`; `widest`: see `WIDEST`.

    `occluders.npy`: by frame, solids before the light's centre, and the width of the largest light's
    penumbra in pixels, (frames, 2, H, W) float16; 0 without a surface, the latter also where no light
    has a penumbra. For methods' errors by occluder.

    Args:
        parts: of test frames. meshes: see `measured_frames`.

    Raises:
        InputError: a file is damaged.
    """
    MEASURES[measure](parts, meshes, output)


def _write_widths(parts: list[Path], meshes: list[Path], output: Path) -> None:
    widths: dict[tuple[str, int], list[np.ndarray]] = defaultdict(list)
    opened = [FrameSetPart(path) for path in parts]
    scenes = list(dict.fromkeys(path.parent.name for path in parts))
    with progress_bar(sum(map(len, opened)), "frames", "widths of penumbrae") as bar:
        for part in opened:
            scene = part.frames_json.parent.name
            for number in range(len(part)):
                valid, edges = part.valid[number, 0], part.edges
                edges = np.zeros_like(valid) if edges is None else edges[number]
                for k in range(len(part.radii)):
                    visibility = part.targets[number, k].astype(np.float32)
                    widths[scene, k].append(local_widths(visibility, valid, edges))
                bar.update()
    radii = range(len(opened[0].radii))
    by_scene = {
        scene: [_percentiles(np.concatenate(widths[scene, k])) for k in radii] for scene in scenes
    }
    about = opened[0].about
    lights = {"radii": about.get("given_radii", about["radii"])}
    lights["radius_unit"] = about.get("radius_unit", "metres")
    summary = {"widest": WIDEST, **lights, "scenes": by_scene}
    write_json(output, summary | describe_origin())


def _percentiles(widths: np.ndarray) -> list[float] | None:
    return np.percentile(widths, PERCENTILES).tolist() if widths.size else None


def _write_occluders(parts: list[Path], meshes: list[Path], output: Path) -> None:
    opened = [FrameSetPart(path) for path in parts]
    total, about = sum(map(len, opened)), opened[0].about
    shape = (total, 2, about["height"], about["width"])
    with (
        new_array(output, shape, np.float16) as occluders,
        progress_bar(total, "frames", "occluders") as bar,
    ):
        for number, frame in enumerate(measured_frames(parts, meshes)):
            occluders[number] = _occluders(frame)
            bar.update()


def _occluders(measured: MeasuredFrame) -> np.ndarray:
    frame, surface = measured.frame, measured.frame.surface
    solids = solids_before(frame.scene, surface, frame.centre)
    focal, radius = surface.camera.focal(surface.height), max(measured.part.radii)
    # Widths are used nowhere else, and sixteen directions a point are most of the work.
    penumbra = ((measured.target >= UMBRA) & (measured.target <= LIT)).any(0)
    selected = np.flatnonzero(penumbra.ravel()[surface.pixel])
    widths = np.zeros(len(surface.p))
    widths[selected] = model_widths(
        frame.scene, surface, frame.centre, radius, focal, selected, frame.shape
    )
    most = np.finfo(np.float16).max
    return np.stack(
        [surface.image(values.clip(0, most)) for values in (np.float32(solids), widths)]
    )


MEASURES = {"widths.json": _write_widths, "occluders.npy": _write_occluders}

if "snakemake" in globals():
    run_stage(snakemake, measure_frames)
