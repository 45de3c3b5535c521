"""Frames side by side: a view of each view set by every method."""

from collections import Counter
from collections.abc import Callable, Collection, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from neural_shadows.evaluation.per_view_metrics import read_metrics
from neural_shadows.metrics.flip import flip_map
from neural_shadows.reports.data.chosen_views import RULE, choose_views
from neural_shadows.reports.data.frame_errors import error_layer
from neural_shadows.reports.data.frames import Frame, read_frames
from neural_shadows.reports.data.inputs import by_folder
from neural_shadows.reports.data.method_look import LOOKS, REFERENCE, look_of
from neural_shadows.reports.page.blocks import webp_uri
from neural_shadows.settings.records import Row

MAP_LEVELS = 64  # of a FLIP map: steps of 0.016, and files a third as large as of 256
REFERENCE_NAME = f"{LOOKS[REFERENCE].symbol} Reference"
# Squared errors in 10⁻⁴, as tables have them.
SCORES = {
    "mse": "MSE {:.1f} × 10⁻⁴",
    "lpips": "LPIPS {:.4f}",
    "psnr": "PSNR {:.2f} dB",
    "flip": "FLIP {:.4f}",
}


def frame_comparisons(
    references: Sequence[Path],
    visibilities: Sequence[Path],
    metrics: Sequence[Path],
    rows: Sequence[Row],
    meshes: Mapping[str, str],
) -> list[dict[str, Any]]:
    """Data for the page's script: frames, errors and FLIP maps by scene.

    Args:
        references, visibilities, metrics: of all batches, in folders of scenes.
        rows: the last of a method counts; meshes: a phrase on the mesh of each scene.
    """
    answered, measured = by_folder(visibilities), by_folder(metrics)
    comparisons = []
    for scene, paths in by_folder(references).items():
        if scene not in measured:
            continue
        values = read_metrics(measured[scene])
        views = [*choose_views(values).values()]
        frames = read_frames(paths, answered.get(scene, []), values, views)
        if not frames:
            continue
        methods = {row["method"]: row for row in rows if row["scene"] == scene}
        title = f"{scene}: {meshes.get(scene, '')}"
        shown = comparison(
            scene, title, frames, _names(methods), _shown_first(methods, frames), _layers
        )
        comparisons.append(shown | {"rule": RULE, "flip": True})
    return comparisons


def comparison(
    name: str,
    title: str,
    frames: Sequence[Frame],
    names: Mapping[str, str],
    left: str,
    layers: Callable[[np.ndarray, np.ndarray], dict[str, Image.Image]],
) -> dict[str, Any]:
    """Data for the page's script: frames and methods to choose among.

    Args:
        names: of methods, with their symbols; left: the method shown first.
        layers: from a method's image and the reference (H, W) in [0, 1], the script's layers over
            the reference (`errors`) or in its place (`map`), by name.
    """
    methods = shared_methods(frames)
    return {
        "name": name,
        "title": title,
        "methods": [{"key": key, "name": names.get(key, key)} for key in methods],
        "left": left,
        "right": REFERENCE,
        "views": [_view(frame, methods, layers) for frame in frames],
    }


def shared_methods(frames: Sequence[Frame]) -> list[str]:
    """Methods of all frames."""
    return [key for key in frames[0].images if all(key in frame.images for frame in frames)]


def _names(rows: Mapping[str, Mapping[str, Any]]) -> dict[str, str]:
    """Methods with their symbols and labels; two of one label bear their keys."""
    counts = Counter(row["label"] for row in rows.values())
    names = {REFERENCE: REFERENCE_NAME}
    for key, row in rows.items():
        names[key] = f"{look_of(row).symbol} {row['label']}"
        if counts[row["label"]] > 1:
            names[key] += f" ({key})"
    return names


def _shown_first(rows: Mapping[str, Mapping[str, Any]], frames: Sequence[Frame]) -> str:
    """The trained network of least error, or else the method."""
    return errs_least(frames, "flip", [key for key, row in rows.items() if row["trained"]])


def errs_least(frames: Sequence[Frame], metric: str, networks: Collection[str]) -> str:
    """The network of least error in the frames, or else the method."""

    def rank(method: str) -> tuple[bool, float]:
        return method not in networks, sum(frame.scores[method][metric] for frame in frames)

    methods = [method for method in shared_methods(frames) if method != REFERENCE]
    return min(methods, key=rank, default=REFERENCE)


def _layers(image: np.ndarray, reference: np.ndarray) -> dict[str, Image.Image]:
    return {
        "errors": Image.fromarray(error_layer(image, reference)),
        "map": map_picture(flip_map(image, reference)),
    }


def _view(frame: Frame, methods: Sequence[str], layers: Callable) -> dict[str, Any]:
    reference = frame.images[REFERENCE]
    pictures = {REFERENCE: {"scores": ""}}
    for method in methods:
        if method == REFERENCE:
            continue
        image, scores = frame.images[method], frame.scores[method]
        shown = {"change": Image.fromarray(change_layer(image, reference))}
        shown |= layers(image, reference)
        pictures[method] = {name: webp_uri(layer) for name, layer in shown.items()} | {
            "scores": ", ".join(SCORES[key].format(scores[key]) for key in SCORES if key in scores)
        }
    height, width = reference.shape
    return {
        "caption": frame.caption,
        "width": width,
        "height": height,
        "reference": webp_uri(Image.fromarray(grey_levels(reference))),
        "pictures": pictures,
    }


def grey_levels(image: np.ndarray) -> np.ndarray:
    """An image in [0, 1] as uint8."""
    return np.round(255 * image).astype(np.uint8)


def change_layer(image: np.ndarray, reference: np.ndarray) -> np.ndarray:
    """Difference layer from the reference: grey and opacity, (H, W, 2) uint8.

    Over the reference it gives the image. A frame of 600 × 400 takes 1 to 5 KB, and 38 whole.
    """
    levels = grey_levels(image)
    opacity = np.where(levels == grey_levels(reference), np.uint8(0), np.uint8(255))
    return np.stack([np.where(opacity, levels, 0), opacity], axis=-1).astype(np.uint8)


def map_picture(error: np.ndarray) -> Image.Image:
    """A FLIP map (H, W) in [0, 1] in the colours of magma, black for none."""
    from matplotlib import colormaps

    level = np.round(np.clip(error, 0, 1) * (MAP_LEVELS - 1)) / (MAP_LEVELS - 1)
    return Image.fromarray((255 * colormaps["magma"](level)[..., :3]).round().astype(np.uint8))
