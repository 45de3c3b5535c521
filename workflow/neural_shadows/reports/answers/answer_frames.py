"""Visibility, pictures and errors of test frames by one method."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from neural_shadows.errors import InputError
from neural_shadows.evaluation.frame_answers import all_radii, constants_of, errors_of
from neural_shadows.evaluation.measured_frames import MeasuredFrame, measured_frames
from neural_shadows.evaluation.soft_registry import METHODS, soft_methods_by_scene
from neural_shadows.files.frame_images import write_images
from neural_shadows.files.whole_files import whole_file
from neural_shadows.frames.frame_set import FrameSetPart
from neural_shadows.frames.light_size import shown_radii
from neural_shadows.metrics.psnr_ssim import ssim
from neural_shadows.reports.data.lights import light_names
from neural_shadows.reports.figures.soft_pictures import answers_alone, strips
from neural_shadows.running.progress import progress_bar
from neural_shadows.running.stage import run_stage


def answer_frames(
    parts: list[Path],
    meshes: list[Path],
    constants_json: Path | None,
    weights: list[Path],
    errors_csv: Path,
    answers: Path,
    *,
    method: str,
    label: str,
    by_scene: bool = False,
) -> None:
    """Evaluate each frame for all radii of its light.

    `SCENE/FRAME.exr` or `.npz` (as an engine's frames came; npz of others) has the visibility of each
    radius, `visibility_K` (H, W) half floats, 1 without a surface; `SCENE/FRAME.png` shows it.
    The errors have a row for each frame and radius; of a frame without targets they are empty.

    Args:
        parts: of test frames. meshes: see `measured_frames`.
        constants_json: of `tune_soft_method`; None for a method without constants.
        weights: of a network, or of one for each scene; none of any other method.
        answers: the folder of the answers.
        label: of the method; by_scene: see `evaluate_soft`.

    Raises:
        InputError: an input file cannot be read, or the method cannot evaluate a frame.
    """
    method_of = soft_methods_by_scene(method, weights, by_scene=by_scene)
    constants = constants_of(constants_json, len(FrameSetPart(parts[0]).radii))
    rows: list[Mapping[str, Any]] = []
    total = sum(len(FrameSetPart(path)) for path in parts)
    with progress_bar(total, "frames", f"answer by {method}") as bar:
        for measured in measured_frames(parts, meshes):
            evaluate = method_of(measured.scene_name)
            if evaluate is None:
                raise InputError(
                    f"{method}: none of its networks is trained on {measured.scene_name}"
                )
            visibility = np.stack([*all_radii(measured, evaluate, constants)])
            form = measured.part.about.get("form", "npz")
            stem = answers / measured.scene_name / _name(measured)
            images = {f"visibility_{k}": image for k, image in enumerate(visibility)}
            write_images(stem.with_name(f"{stem.name}.{form}"), images)
            _draw(measured, visibility, label, stem.with_name(f"{stem.name}.png"))
            rows += _rows(measured, visibility)
            bar.update()
    _write_rows(errors_csv, rows)


def _name(measured: MeasuredFrame) -> str:
    """A frame's name: an engine's folder, or `test_000_7`."""
    part = measured.part
    if "source" in part.about:
        return Path(part.about["source"]).name
    return f"{part.frames_json.stem}_{measured.number}"


def _rows(measured: MeasuredFrame, visibility: np.ndarray) -> list[dict[str, Any]]:
    about = measured.part.about
    given = about.get("given_radii", about["radii"])
    key = {"scene": measured.scene_name, "frame": _name(measured)}
    key |= {"width": about["width"], "height": about["height"], "pixels": measured.valid.sum()}
    rows = []
    for k, radius in enumerate(given):
        row = {**key, "radius": radius, "radius_unit": about.get("radius_unit", "metres")}
        exact = measured.part.has_targets
        rows.append(row | (errors_of(measured, visibility[k], k, {"ssim": ssim}) if exact else {}))
    return rows


def _write_rows(path: Path, rows: list[Mapping[str, Any]]) -> None:
    import pandas as pd

    with whole_file(path) as part:
        pd.DataFrame(rows).to_csv(part, index=False, lineterminator="\n")


def _draw(measured: MeasuredFrame, visibility: np.ndarray, label: str, png: Path) -> None:
    about = measured.part.about
    shown = shown_radii(len(visibility))
    lights = [light_names(about)[k] for k in shown]
    bases = [one for one in METHODS.values() if one.channel in about["channels"]]
    pictures = {one.label: [measured.picture(one.channel)] * len(shown) for one in bases}
    pictures[label] = [visibility[k] for k in shown]
    title = f"{label}: {measured.scene_name}, {_name(measured)}"
    if measured.part.has_targets:
        targets = [measured.target[k] for k in shown]
        figure = strips(pictures, targets, measured.valid, lights, title)
    else:
        figure = answers_alone(pictures, lights, title)
    with whole_file(png) as part:
        figure.savefig(part)


if "snakemake" in globals():
    run_stage(snakemake, answer_frames)
