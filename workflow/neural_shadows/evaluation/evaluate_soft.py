"""Stage: one soft-shadow method on test frames and sequences."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from itertools import groupby
from pathlib import Path
from typing import Any

import numpy as np

from neural_shadows.evaluation.frame_answers import all_radii, constants_of, errors_of
from neural_shadows.evaluation.measure_occluders import read_occluders
from neural_shadows.evaluation.measured_frames import MeasuredFrame, measured_frames
from neural_shadows.evaluation.soft_answers import flicker_name, name_of, write_answers
from neural_shadows.evaluation.soft_method import Constants, SoftMethod
from neural_shadows.evaluation.soft_metrics import write_soft_metrics
from neural_shadows.evaluation.soft_registry import soft_methods_by_scene, take_fields
from neural_shadows.frames.frame_set import FrameSetPart
from neural_shadows.frames.soft_frame import SoftFrame
from neural_shadows.metrics.available_lpips import lpips_metric
from neural_shadows.metrics.flip import flip
from neural_shadows.metrics.instability import exponential_instability, root_instability
from neural_shadows.metrics.occluder_error import errors_by_occluders
from neural_shadows.metrics.psnr_ssim import ssim
from neural_shadows.rendering.reprojection import looked_up, seen_before
from neural_shadows.running.progress import progress_bar
from neural_shadows.running.stage import run_stage

Row = Mapping[str, Any]


def evaluate_soft(
    parts: list[Path],
    sequences: list[Path],
    meshes: list[Path],
    constants_json: Path | None,
    weights: list[Path],
    lpips_json: Path,
    metrics_csv: Path,
    answers_npz: Path,
    *,
    occluders: list[Path],
    fields: list[Path] = (),
    method: str,
    precision: str = "auto",
    by_scene: bool = False,
    threads: int = 1,
) -> None:
    """Measure a method on test frames, and its flicker.

    Writes tidy metrics, see `write_soft_metrics`, and the images of each part's first frame, see
    `write_answers`.

    Args:
        parts: of test frames. sequences: parts of consecutive frames; may be none.
        meshes: see `measured_frames`.
        constants_json: of `tune_soft_method`; None for a method without constants.
        weights: of a network; none for any other method.
        lpips_json: of `find_lpips`; LPIPS is left out where it is not available.
        occluders: of `measure_occluders`, by part; none for a method without errors by occluder.
        fields: of `fit_fields`, for a method that needs them.
        precision: number format of a network, see `choose_dtype`.
        by_scene: evaluate each of the networks of `weights` on its training scenes alone.

    Raises:
        InputError: an input file cannot be read.
    """
    take_fields([method], fields)
    method_of = soft_methods_by_scene(method, weights, precision, by_scene)
    constants = constants_of(constants_json, len(FrameSetPart(parts[0]).radii))
    quick = {"ssim": ssim}
    # 0.3 s of a picture of 512 × 256, where the errors take 0.01: of each part's first frame by the
    # middle light alone. By all five lights they took half of a method's time.
    images = quick | {"flip": flip} | lpips_metric(lpips_json, threads)

    rows: list[Row] = []
    answers: dict[str, np.ndarray] = {}  # for figures
    blocking = dict(zip(parts, map(read_occluders, occluders)))
    paths = [*parts, *sequences]
    total = sum(len(FrameSetPart(path)) for path in paths)
    with progress_bar(total, "frames", f"evaluate {method}") as bar:
        # One call for all opens each scene once.
        by_part = groupby(
            measured_frames(paths, meshes), lambda measured: measured.part.frames_json
        )
        for path, frames in by_part:
            scene_method = method_of(path.parent.name)
            if scene_method is None:
                bar.update(sum(1 for _ in frames))
                continue
            if path in sequences:
                sequence_rows, maps = _flicker(frames, scene_method, constants, bar.update)
                rows += sequence_rows
                answers |= {
                    flicker_name(path): maps[""],
                    flicker_name(path, True): maps["_reference"],
                }
                continue
            for measured in frames:
                for k, visibility in enumerate(all_radii(measured, scene_method, constants)):
                    metrics = quick
                    if measured.number == 0:
                        answers[name_of(path, k)] = visibility
                        if k == _middle(measured.part):
                            metrics = images
                    values = errors_of(measured, visibility, k, metrics)
                    if path in blocking:
                        target, valid = measured.target[k], measured.valid
                        blocks = blocking[path][measured.number].astype(np.float32)
                        values |= errors_by_occluders(visibility, target, valid, *blocks)
                    key = _key(measured.part, measured.number, k)
                    rows += [
                        {**key, "metric": name, "value": value} for name, value in values.items()
                    ]
                bar.update()
    write_soft_metrics(metrics_csv, rows)
    write_answers(answers_npz, answers)


def _flicker(
    frames: Iterable[MeasuredFrame],
    method: SoftMethod,
    constants: Sequence[Constants],
    advance: Callable[[], Any],
) -> tuple[list[Row], dict[str, np.ndarray]]:
    """Instability over a sequence, of the middle radius.

    Of the method, the exact shadow, and the method's frames each averaged with the one before
    (`_taa`); with squared errors. One frame of history is what Datta et al. 2022 (4) compare with.
    With it, mean changes of each pixel, (height, width).
    """
    changes: dict[str, list[np.ndarray]] = {"": [], "_reference": [], "_taa": []}
    errors: dict[str, list[float]] = {"_sequence": [], "_taa": []}
    images = _answered(frames, method, constants)
    before, last, _ = next(images)
    averaged = last
    sums = {name: np.zeros(last.size, np.float32) for name in changes}
    advance()
    part, k = before.part, _middle(before.part)
    for now, visibility, (accepted, pixels_before) in images:
        pixel, pixels_before = now.frame.surface.pixel[accepted], pixels_before[:, accepted]
        target, valid = now.target[k], now.valid
        blended = visibility.copy()
        blended.ravel()[pixel] += (looked_up(last, pixels_before) - blended.ravel()[pixel]) / 2
        for name, old, new in (
            ("", last, visibility),
            ("_reference", before.target[k], target),
            ("_taa", averaged, blended),
        ):
            changes[name].append(new.ravel()[pixel] - looked_up(old, pixels_before))
            sums[name][pixel] += np.abs(changes[name][-1])
        for name, image in (("_sequence", visibility), ("_taa", blended)):
            errors[name].append(float(np.square(image - target)[valid].mean()))
        before, last, averaged = now, visibility, blended
        advance()
    key = _key(part, 0, k)
    pixels = part.about["width"] * part.about["height"]
    values = {f"mse{name}": float(np.mean(each)) for name, each in errors.items()}
    for name, each in changes.items():
        values[f"instability{name}"] = exponential_instability(each)
        values[f"temporal_error{name}"] = root_instability(each, pixels)
    rows = [{**key, "metric": name, "value": value} for name, value in values.items()]
    count = len(errors["_sequence"])
    return rows, {name: (total / count).reshape(last.shape) for name, total in sums.items()}


def _middle(part: FrameSetPart) -> int:
    return len(part.radii) // 2


Seen = tuple[np.ndarray, np.ndarray]


def _answered(
    frames: Iterable[MeasuredFrame], method: SoftMethod, constants: Sequence[Constants]
) -> Iterator[tuple[MeasuredFrame, np.ndarray, Seen | None]]:
    """Each frame, the method's image, and what is still visible.

    The last is None at first. A method with a history runs through all frames in turn.
    """
    history = None
    points_before: list[np.ndarray | None] = []  # of the current frame
    waiting: list[SoftFrame] = []
    before = None
    for now in frames:
        k = _middle(now.part)
        radius, chosen = now.part.radii[k], constants[k]
        seen, points = _seen(before, now) if before else (None, None)
        if method.sequence is None:
            yield now, now.answered(method, radius, chosen), seen
        else:
            waiting.append(now.frame)
            points_before.append(points)
            if history is None:
                history = method.sequence(
                    _taken(waiting), radius, was=_taken(points_before), **chosen
                )
            yield now, now.frame.surface.image(next(history), 1.0), seen
        before = now


def _taken(waiting: list[Any]) -> Iterator[Any]:
    """Pop items of a growing list."""
    while waiting:
        yield waiting.pop(0)


def _key(part: FrameSetPart, frame: int, radius: int) -> dict[str, Any]:
    path = part.frames_json
    return {"scene": path.parent.name, "part": path.stem, "frame": frame, "radius": radius}


def _seen(before: MeasuredFrame, now: MeasuredFrame) -> tuple[Seen, np.ndarray]:
    """Reprojection of valid points into the previous frame.

    Accepted points and their pixels there (see `seen_before`), and their previous positions (n, 3).
    """
    surface, scene = now.frame.surface, now.scene
    motions = (frame.part.setting(frame.number).motion for frame in (now, before))
    points_before = scene.before(now.frame.scene, surface.face, surface.p, *motions)
    accepted, pixels_before = seen_before(surface, before.frame.surface, points_before)
    return (accepted & now.valid.ravel()[surface.pixel], pixels_before), points_before


if "snakemake" in globals():
    run_stage(snakemake, evaluate_soft)
