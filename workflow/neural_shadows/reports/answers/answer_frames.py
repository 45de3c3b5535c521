"""Visibility, pictures and errors of test frames by one method."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from neural_shadows.errors import InputError
from neural_shadows.evaluation.frame import Inputs, constants_of
from neural_shadows.evaluation.frame_metrics import image_errors
from neural_shadows.evaluation.measured_frames import MeasuredFrame, measured_frames, open_methods
from neural_shadows.evaluation.registry import is_network
from neural_shadows.files.frame_images import write_images
from neural_shadows.files.whole_files import whole_file
from neural_shadows.frames.buffers import LIT
from neural_shadows.frames.feature_names import buffers_of
from neural_shadows.frames.frame_set import FrameSetPart
from neural_shadows.frames.kernel_features import PENUMBRA_PIXELS, blocker, penumbra_pixels
from neural_shadows.metrics.registry import image_metrics
from neural_shadows.reports.data.frame_errors import Window
from neural_shadows.reports.data.lights import light_names, radii_of, shown_radii
from neural_shadows.reports.data.soft_pictures import pictures_of
from neural_shadows.reports.drawing.soft_sheet import whole_sheet
from neural_shadows.running.progress import progress_bar, warn
from neural_shadows.running.stage import run_stage

CROP = 256  # pixels along both sides of a crop
WIDE_SHARE = 0.01  # of a frame's pixels, below which nothing is said
COUNTS = ["frame_width", "frame_height", "pixels"]


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
    radius, `visibility_K` (H, W) half floats, 1 without a surface; `SCENE/FRAME*.png` show it.
    The errors have a row for each frame and radius, and the means by radius; of a frame without targets
    they are empty. `mse_of_hard` and the like are those of the frame's base shadows.

    Args:
        parts: of test frames. meshes: see `measured_frames`.
        constants_json: of `tune`; None for a method without constants.
        weights: of a network, or of one for each scene; none of any other method.
        answers: the folder of the answers.
        label: of the method; by_scene: see `evaluate`.

    Raises:
        InputError: an input file cannot be read, or the method cannot evaluate a frame.
    """
    method_of = open_methods(method, Inputs(parts, meshes, weights, by_scene=by_scene))
    wide = np.zeros(len(FrameSetPart(parts[0]).radii))
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
            visibility = np.stack([*measured.visibilities(evaluate, constants)])
            form = measured.part.about.get("form", "npz")
            stem = answers / measured.scene_name / _name(measured)
            images = {f"visibility_{k}": image for k, image in enumerate(visibility)}
            write_images(stem.with_name(f"{stem.name}.{form}"), images)
            _draw(measured, visibility, label, stem)
            rows += _rows(measured, visibility)
            if is_network(method):
                wide = np.maximum(wide, _wide_penumbrae(measured))
            bar.update()
    _write_rows(errors_csv, rows)
    if (wide > WIDE_SHARE).any():
        light = light_names(FrameSetPart(parts[0]).about)[int(wide.argmax())]
        warn(
            f"{method}: under a {light} penumbrae are wider than the {PENUMBRA_PIXELS:.0f} pixels "
            f"that features tell apart in up to {100 * wide.max():.0f} % of a frame's pixels, and come "
            "out too narrow. Render smaller frames, or take a smaller light"
        )


def _wide_penumbrae(measured: MeasuredFrame) -> np.ndarray:
    """Share of pixels with penumbrae beyond the features' range, by radius.

    0 for frames without the buffers.
    """
    part = measured.part
    names = buffers_of(["penumbra"])
    if not {*names} <= {*part.about["channels"]}:
        return np.zeros(len(part.radii))
    buffers = {name: measured.picture(name) for name in names}
    places = [buffers["z"], blocker(buffers), *(buffers[name] for name in ("d", "c_e", "c_v"))]
    focal = part.lens(measured.number).focal
    widths = (penumbra_pixels(*places, part.light_size(radius), focal) for radius in part.radii)
    return np.array([np.mean(image[measured.valid] > PENUMBRA_PIXELS) for image in widths])


def _name(measured: MeasuredFrame) -> str:
    """A frame's name: an engine's folder, or `test_000_7`."""
    part = measured.part
    if "source" in part.about:
        return Path(part.about["source"]).name
    return f"{part.frames_json.stem}_{measured.number}"


def _rows(measured: MeasuredFrame, visibility: np.ndarray) -> list[dict[str, Any]]:
    about = measured.part.about
    key = {"scene": measured.scene_name, "frame": _name(measured)}
    key |= {"frame_width": about["width"], "frame_height": about["height"]}
    key |= {"pixels": measured.valid.sum()}
    rows, images = [], image_metrics("soft", slow=False)
    for k, radius in enumerate(radii_of(about)):
        row = {**key, "radius": radius, "radius_unit": about.get("radius_unit", "metres")}
        if measured.part.has_targets:
            row |= image_errors(measured, visibility[k], k, images)
            for base in _bases(measured):
                errors = image_errors(measured, measured.picture(base), k, images)
                row[f"mse_of_{base}"] = errors["mse"]
        rows.append(row)
    return rows


def _bases(measured: MeasuredFrame) -> list[str]:
    """Channels of a frame that are visibilities: its base shadows."""
    return [channel for channel in LIT if channel in measured.part.about["channels"]]


def _write_rows(path: Path, rows: list[Mapping[str, Any]]) -> None:
    """Write rows, and below them the means over all frames by radius."""
    import pandas as pd

    table = pd.DataFrame(rows)
    measured = [*table.columns[table.columns.get_loc("radius_unit") + 1 :]]
    if measured:
        means = table.groupby(["radius", "radius_unit"], sort=False)[measured].mean()
        means = means.reset_index().assign(scene="all", frame="mean")
        table = pd.concat([table, means])[table.columns]
        table[COUNTS] = table[COUNTS].astype("Int64")
    with whole_file(path) as part:
        table.to_csv(part, index=False, lineterminator="\n")


def _draw(measured: MeasuredFrame, visibility: np.ndarray, label: str, stem: Path) -> None:
    """Draw a frame's visibility whole, beside its bases, and a crop where it differs from them.

    `FRAME_visibility_K.png` has a pixel for each of the frame's, `FRAME.png` and `FRAME_crop.png` several radii.
    """
    for k, image in enumerate(visibility):
        with whole_file(stem.with_name(f"{stem.name}_visibility_{k}.png")) as part:
            Image.fromarray(np.round(255 * image).astype(np.uint8)).save(part, format="png")
    shown, bases = shown_radii(measured.part.radii), _bases(measured)
    answers = {base: np.stack([measured.picture(base)] * len(shown)) for base in bases}
    answers["own"] = visibility[shown]
    labels = {base: f"its {base}" for base in bases} | {"own": label}
    part, number = measured.part, measured.number
    exact = measured.target[shown] if part.has_targets else None
    names = light_names(part.about)
    pictures = pictures_of(part, number, [names[k] for k in shown], exact, answers)
    windows = {"": Window(0, 0, *measured.valid.shape)}
    if min(measured.valid.shape) > CROP:
        first, *_ = answers.values()
        windows["_crop"] = _window(np.abs(visibility[shown[-1]] - first[-1]))
    for ending, window in windows.items():
        figure = whole_sheet(pictures, labels, f"{label}: {_name(measured)}", window)
        with whole_file(stem.with_name(f"{stem.name}{ending}.png")) as path:
            figure.savefig(path)


def _window(difference: np.ndarray) -> Window:
    """The square of `CROP` pixels with the largest sum of differences (H, W)."""
    from scipy.ndimage import uniform_filter

    half = CROP // 2
    inner = uniform_filter(difference, CROP, mode="constant")[half:-half, half:-half]
    row, column = np.unravel_index(inner.argmax(), inner.shape)
    return Window(int(row), int(column), CROP, CROP)


if "snakemake" in globals():
    run_stage(snakemake, answer_frames)
