"""The page's frames to compare: a view of each view set by every method, for each scene."""

from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from neural_shadows.evaluation.per_view_metrics import read_metrics
from neural_shadows.metrics.flip import flip_map
from neural_shadows.reports.chosen_views import RULE, choose_views
from neural_shadows.reports.frame_errors import error_layer
from neural_shadows.reports.frames import Frame, read_frames
from neural_shadows.reports.inputs import by_folder
from neural_shadows.reports.method_look import LOOKS, REFERENCE, look_of
from neural_shadows.reports.page_blocks import webp_uri

MAP_LEVELS = 64  # of a FLIP map: steps of 0.016, and files a third as large as of 256
SCORES = {"lpips": "LPIPS {:.4f}", "psnr": "PSNR {:.2f} dB", "flip": "FLIP {:.4f}"}


def frame_comparisons(
    references: Sequence[Path],
    visibilities: Sequence[Path],
    metrics: Sequence[Path],
    rows: Sequence[Mapping[str, Any]],
    meshes: Mapping[str, str],
) -> list[dict[str, Any]]:
    """The frames, errors and FLIP maps of each scene that has some, as data for the page's script.

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
        # Of a page that is made half-way: what each of the views has.
        methods = [key for key in frames[0].images if all(key in one.images for one in frames)]
        here = {row["method"]: row for row in rows if row["scene"] == scene}
        comparisons.append(
            {
                "scene": scene,
                "title": f"{scene}: {meshes.get(scene, '')}",
                "rule": RULE,
                "methods": [{"key": key, "name": name} for key, name in _names(methods, here)],
                "left": _shown_first(methods, here, frames),
                "right": REFERENCE,
                "views": [_view(frame, methods) for frame in frames],
            }
        )
    return comparisons


def _names(methods: Sequence[str], rows: Mapping[str, Mapping[str, Any]]) -> list[tuple[str, str]]:
    """Methods with their symbols and labels; two of one label bear their keys."""
    counts = Counter(row["label"] for row in rows.values())
    names = {REFERENCE: f"{LOOKS[REFERENCE].symbol} Reference"}
    for key, row in rows.items():
        names[key] = f"{look_of(row).symbol} {row['label']}"
        if counts[row["label"]] > 1:
            names[key] += f" ({key})"
    return [(key, names.get(key, key)) for key in methods]


def _shown_first(
    methods: Sequence[str], rows: Mapping[str, Mapping[str, Any]], frames: Sequence[Frame]
) -> str:
    """The trained network that errs least in the frames, or the method that does."""

    def rank(method: str) -> tuple[bool, float]:
        trained = method in rows and rows[method]["trained"]
        return not trained, sum(one.scores[method]["flip"] for one in frames)

    return min([m for m in methods if m != REFERENCE], key=rank, default=REFERENCE)


def _view(frame: Frame, methods: Sequence[str]) -> dict[str, Any]:
    reference = frame.images[REFERENCE]
    pictures = {REFERENCE: {"scores": ""}}
    for method in methods:
        if method == REFERENCE:
            continue
        image, scores = frame.images[method], frame.scores[method]
        pictures[method] = {
            "change": webp_uri(Image.fromarray(change_layer(image, reference))),
            "errors": webp_uri(Image.fromarray(error_layer(image, reference))),
            "map": webp_uri(map_picture(flip_map(image, reference))),
            "scores": ", ".join(SCORES[key].format(scores[key]) for key in SCORES if key in scores),
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
    """What makes a grey image of the reference when laid over it: grey and opacity, (H, W, 2) uint8.

    A frame of 600 × 400 takes 1 to 5 KB so, and 38 whole.
    """
    levels = grey_levels(image)
    opacity = np.where(levels == grey_levels(reference), np.uint8(0), np.uint8(255))
    return np.stack([np.where(opacity, levels, 0), opacity], axis=-1).astype(np.uint8)


def map_picture(error: np.ndarray) -> Image.Image:
    """A FLIP map (H, W) in [0, 1] in the colours of magma, black for none."""
    from matplotlib import colormaps

    level = np.round(np.clip(error, 0, 1) * (MAP_LEVELS - 1)) / (MAP_LEVELS - 1)
    return Image.fromarray((255 * colormaps["magma"](level)[..., :3]).round().astype(np.uint8))
