"""The page's frames to compare: a view of each view set by every method, for each scene."""

from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from neural_shadows.evaluation.method_names import is_classic, unbiased
from neural_shadows.evaluation.per_view_metrics import read_metrics
from neural_shadows.metrics.flip import flip_map
from neural_shadows.reports.chosen_views import choose_views
from neural_shadows.reports.frames import REFERENCE, Frame, read_frames
from neural_shadows.reports.inputs import by_folder
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
    """The frames and FLIP maps of each scene that has some, as plain data for the page's script.

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
        networks = [name for name in methods[1:] if not is_classic(unbiased(name))]
        labels = {row["method"]: row["label"] for row in rows if row["scene"] == scene}
        names = {REFERENCE: "Reference"} | labels
        counts = Counter(labels.values())  # two methods of one label bear their keys
        names |= {key: f"{label} ({key})" for key, label in labels.items() if counts[label] > 1}
        comparisons.append(
            {
                "scene": scene,
                "title": f"{scene}: {meshes.get(scene, '')}",
                "methods": [{"key": key, "name": names.get(key, key)} for key in methods],
                "left": (networks or methods[1:] or methods)[0],
                "right": REFERENCE,
                "views": [_view(frame) for frame in frames],
            }
        )
    return comparisons


def _view(frame: Frame) -> dict[str, Any]:
    reference = frame.images[REFERENCE]
    pictures = {}
    for method, image in frame.images.items():
        scores = frame.scores.get(method, {})
        error = flip_map(image, reference)
        pictures[method] = {
            "frame": webp_uri(Image.fromarray(np.round(255 * image).astype(np.uint8))),
            "map": webp_uri(map_picture(error)),
            "scores": ", ".join(SCORES[key].format(scores[key]) for key in SCORES if key in scores),
        }
    height, width = reference.shape
    return {"caption": frame.caption, "width": width, "height": height, "pictures": pictures}


def map_picture(error: np.ndarray) -> Image.Image:
    """A FLIP map (H, W) in [0, 1] in the colours of magma, black for none."""
    from matplotlib import colormaps

    level = np.round(np.clip(error, 0, 1) * (MAP_LEVELS - 1)) / (MAP_LEVELS - 1)
    return Image.fromarray((255 * colormaps["magma"](level)[..., :3]).round().astype(np.uint8))
