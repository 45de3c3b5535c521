"""The stage that measures one method for soft shadows on test frames and sequences."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from neural_shadows.evaluation.evaluate import lpips_metric
from neural_shadows.evaluation.measured_frames import MeasuredFrame, measured_frames
from neural_shadows.evaluation.soft_answers import name_of, write_answers
from neural_shadows.evaluation.soft_methods.registry import METHODS
from neural_shadows.evaluation.soft_metrics import write_soft_metrics
from neural_shadows.files.whole_files import read_json
from neural_shadows.frames.frame_set import FrameSetPart
from neural_shadows.metrics.flip import flip
from neural_shadows.metrics.instability import exponential_instability, root_instability
from neural_shadows.metrics.psnr_ssim import ssim
from neural_shadows.metrics.visibility_error import visibility_errors
from neural_shadows.rendering.reprojection import looked_up, seen_before
from neural_shadows.running.progress import progress_bar
from neural_shadows.running.stage import run_stage

Row = Mapping[str, Any]
Answer = Callable[[MeasuredFrame, int], np.ndarray]


def evaluate_soft(
    parts: list[Path],
    sequences: list[Path],
    meshes: list[Path],
    constants_json: Path,
    lpips_json: Path,
    metrics_csv: Path,
    answers_npz: Path,
    *,
    method: str,
    threads: int = 1,
) -> None:
    """Measure a method on all radii of each test frame, and how much it flickers in sequences.

    Writes tidy metrics, see `write_soft_metrics`, and what was answered, see `write_answers`.

    Args:
        parts: of test frames. sequences: parts of consecutive frames; may be none.
        meshes: see `measured_frames`.
        constants_json: what `tune_soft_method` wrote.
        lpips_json: what `find_lpips` wrote; LPIPS is left out where it is not available.

    Raises:
        InputError: an input file cannot be read.
    """
    asked = METHODS[method]
    constants = [one["constants"] for one in read_json(constants_json)["radii"]]
    images = {"ssim": ssim, "flip": flip} | lpips_metric(lpips_json, threads)

    # What neither the radius nor other constants change is asked once.
    changes = asked.of_radius or any(one != constants[0] for one in constants)

    def answer(measured: MeasuredFrame, k: int) -> np.ndarray:
        return measured.answered(asked, measured.part.radii[k], constants[k])

    rows: list[Row] = []
    kept: dict[str, np.ndarray] = {}
    total = sum(len(FrameSetPart(path)) for path in [*parts, *sequences])
    with progress_bar(total, "frames", f"evaluate {method}") as bar:
        for measured in measured_frames(parts, meshes):
            for k in range(len(measured.part.radii)):
                found = answer(measured, k) if k == 0 or changes else found
                kept[name_of(measured.part.frames_json, measured.number, k)] = found
                key = _key(measured.part, measured.number, k)
                values = _values(measured, found, k, images)
                rows += [{**key, "metric": name, "value": value} for name, value in values.items()]
            bar.update()
        for path in sequences:
            rows += _flicker([*measured_frames([path], meshes)], answer, bar.update)
    write_soft_metrics(metrics_csv, rows)
    write_answers(answers_npz, kept)


def _values(
    measured: MeasuredFrame, found: np.ndarray, k: int, images: Mapping[str, Callable]
) -> dict[str, float]:
    """The metrics of one image; those of pictures see the target where a pixel does not count."""
    target, valid = measured.target, measured.valid
    picture = np.where(valid, found, target[k])
    return {
        **visibility_errors(found, target[k], valid, target[0]),
        **{name: metric(picture, target[k]) for name, metric in images.items()},
    }


def _flicker(
    frames: Sequence[MeasuredFrame], answer: Answer, told: Callable[[], Any]
) -> Iterator[Row]:
    """Instability over a sequence, of the middle radius: the method's, and the exact shadow's own."""
    part = frames[0].part
    k = len(part.radii) // 2
    changes: dict[str, list[np.ndarray]] = {"": [], "_reference": []}
    last = answer(frames[0], k)
    told()
    for before, now in pairwise(frames):
        accepted, places = _seen(before, now)
        pixel = now.frame.surface.pixel[accepted]
        found = answer(now, k)
        for name, old, new in (
            ("", last, found),
            ("_reference", before.target[k], now.target[k]),
        ):
            moved = looked_up(old, places[:, accepted])
            changes[name].append(new.ravel()[pixel] - moved)
        last = found
        told()
    key = _key(part, 0, k)
    pixels = part.about["width"] * part.about["height"]
    for name, each in changes.items():
        yield {**key, "metric": f"instability{name}", "value": exponential_instability(each)}
        yield {**key, "metric": f"temporal_error{name}", "value": root_instability(each, pixels)}


def _key(part: FrameSetPart, frame: int, radius: int) -> dict[str, Any]:
    path = part.frames_json
    return {"scene": path.parent.name, "part": path.stem, "frame": frame, "radius": radius}


def _seen(before: MeasuredFrame, now: MeasuredFrame) -> tuple[np.ndarray, np.ndarray]:
    """Which points of a frame count and are seen in the one before, and where; see `seen_before`."""
    surface, scene = now.frame.surface, now.scene
    motions = (frame.part.setting(frame.number).motion for frame in (now, before))
    was = scene.before(now.frame.scene, surface.face, surface.p, *motions)
    accepted, places = seen_before(surface, before.frame.surface, was)
    return accepted & now.valid.ravel()[surface.pixel], places


if "snakemake" in globals():
    run_stage(snakemake, evaluate_soft)
