"""Hard frames side by side: pictures by two methods under a divider."""

from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from neural_shadows.evaluation.metric_files import read_view_metrics
from neural_shadows.metrics.kinds.flip import flip_map
from neural_shadows.metrics.registry import metrics as metrics_by_key
from neural_shadows.reports.data import chosen_views
from neural_shadows.reports.data.frame_errors import error_layer
from neural_shadows.reports.data.frames import Frame, read_frames
from neural_shadows.reports.data.inputs import by_folder
from neural_shadows.reports.data.method_look import LOOKS, REFERENCE, kind_of, look_of
from neural_shadows.reports.page.blocks import lossless_uri, lossy_uri
from neural_shadows.settings.records import Row

REFERENCE_NAME = f"{LOOKS[REFERENCE].symbol} Reference"
SCORES = ("lpips", "psnr", "flip")
MAP_QUALITY = 40


def hard_comparisons(
    references: Sequence[Path],
    visibilities: Sequence[Path],
    metrics: Sequence[Path],
    rows: Sequence[Row],
    meshes: Mapping[str, str],
) -> list[dict[str, Any]]:
    """Data for the page's script: views, errors and FLIP maps by scene.

    Args:
        references, visibilities, metrics: of all batches, in folders of scenes.
        rows: the last of a method counts; meshes: a phrase on the mesh of each scene.
    """
    answered, measured = by_folder(visibilities), by_folder(metrics)
    comparisons = []
    for scene, paths in by_folder(references).items():
        if scene not in measured:
            continue
        values = read_view_metrics(measured[scene])
        views = [*chosen_views.choose_views(values).values()]
        frames = read_frames(paths, answered.get(scene, []), values, views)
        if not frames or len(_shared_methods(frames)) < 2:  # nothing beside the reference
            continue
        methods = {row["method"]: row for row in rows if row["scene"] == scene}
        counts = Counter(row["label"] for row in methods.values())
        # Two of one label bear their keys.
        names = {
            key: f"{look_of(row).symbol} {row['label']}{f' ({key})' * (counts[row['label']] > 1)}"
            for key, row in methods.items()
        }
        shared, names = _shared_methods(frames), {REFERENCE: REFERENCE_NAME, **names}
        comparisons.append(
            {
                "name": scene,
                "title": f"{scene}: {meshes.get(scene, '')}",
                "rule": chosen_views.RULE,
                "soft": False,
                "methods": [{"key": key, "name": names.get(key, key)} for key in shared],
                "left": _first_shown(frames, methods),
                "right": REFERENCE,
                "views": [_view(frame, shared) for frame in frames],
            }
        )
    return comparisons


def _shared_methods(frames: Sequence[Frame]) -> list[str]:
    """Methods of all frames."""
    return [key for key in frames[0].images if all(key in frame.images for frame in frames)]


def _first_shown(frames: Sequence[Frame], rows: Mapping[str, Row]) -> str:
    """The thesis's network, else another trained one, else the method; of several that of least FLIP.

    The best method of all may look like the reference, and the divider would show nothing.
    """

    def rank(method: str) -> tuple[bool, bool, float]:
        row = rows.get(method)
        thesis, trained = row and kind_of(row) == "frequency", row and row["trained"]
        return not thesis, not trained, sum(frame.scores[method]["flip"] for frame in frames)

    methods = [method for method in _shared_methods(frames) if method != REFERENCE]
    return min(methods, key=rank, default=REFERENCE)


def _view(frame: Frame, methods: Sequence[str]) -> dict[str, Any]:
    reference = frame.images[REFERENCE]
    pictures = {REFERENCE: {"scores": ""}}
    for method in methods:
        if method == REFERENCE:
            continue
        image, scores = frame.images[method], frame.scores[method]
        pictures[method] = {
            "change": lossless_uri(Image.fromarray(change_layer(image, reference))),
            "errors": lossless_uri(Image.fromarray(error_layer(image, reference))),
            "map": lossy_uri(map_picture(flip_map(image, reference)), MAP_QUALITY),
            "scores": ", ".join(
                metrics_by_key()[key].score(scores[key]) for key in SCORES if key in scores
            ),
        }
    height, width = reference.shape
    return {
        "caption": frame.caption,
        "width": width,
        "height": height,
        "reference": lossless_uri(Image.fromarray(grey_levels(reference))),
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
    """A FLIP map (H, W) in [0, 1] in the colours of magma, black for none, at half the size.

    Of 600 × 400 it takes 3 KB, at full size 7, without loss 16.
    """
    from matplotlib import colormaps

    colours = (255 * colormaps["magma"](error)[..., :3]).round().astype(np.uint8)
    return Image.fromarray(colours).reduce(2)
