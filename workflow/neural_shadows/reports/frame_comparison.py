"""The page's frames to compare: the first views of each scene by every method."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from neural_shadows.evaluation.first_frames import FirstFrame, read_first_frames
from neural_shadows.evaluation.method_names import is_shadow_map
from neural_shadows.metrics.flip import Flip
from neural_shadows.reports.inputs import by_folder
from neural_shadows.reports.page_blocks import webp_uri

REFERENCE = "reference"
MAP_LEVELS = 64  # of a FLIP map: steps of 0.016, and files a third as large as of 256
SCORES = {"lpips": "LPIPS {:.4f}", "psnr": "PSNR {:.2f} dB", "flip": "FLIP {:.4f}"}


def frame_comparisons(
    pictures: Sequence[Path],
    metrics: Sequence[Path],
    rows: Sequence[Mapping[str, Any]],
    meshes: Mapping[str, str],
) -> list[dict[str, Any]]:
    """The frames of each scene as `frame_comparison` gives them.

    Args:
        pictures, metrics: the first batches, in folders of scenes.
        rows: `method`, `scene` and `label` of methods.
        meshes: a phrase on the mesh of each scene.
    """
    scores = by_folder(metrics)
    return [
        frame_comparison(
            scene,
            f"{scene}: {meshes[scene]}",
            read_first_frames(paths, scores[scene]),
            {row["method"]: row["label"] for row in rows if row["scene"] == scene},
        )
        for scene, paths in by_folder(pictures).items()
    ]


def frame_comparison(
    scene: str, title: str, frames: Sequence[FirstFrame], labels: Mapping[str, str]
) -> dict[str, Any]:
    """A scene's frames and FLIP maps as plain data for the page's script.

    The maps show each method against the reference.
    """
    methods = sorted(frames[0].images, key=lambda method: method != REFERENCE)
    networks = [name for name in methods if name != REFERENCE and not is_shadow_map(name)]
    names = {REFERENCE: "Reference", **labels}
    return {
        "scene": scene,
        "title": title,
        "methods": [{"key": method, "name": names.get(method, method)} for method in methods],
        "left": (networks or methods[1:] or methods)[0],
        "right": REFERENCE,
        "views": [_view(frame) for frame in frames],
    }


def _view(frame: FirstFrame) -> dict[str, Any]:
    reference = frame.images[REFERENCE].astype(np.float32) / 255
    flip = Flip(reference)
    pictures = {}
    for method, image in frame.images.items():
        scores = frame.scores.get(method, {})
        pictures[method] = {
            "frame": webp_uri(Image.fromarray(image)),
            "map": webp_uri(map_picture(flip.error_map(image.astype(np.float32) / 255))),
            "scores": ", ".join(
                text.format(scores[name]) for name, text in SCORES.items() if name in scores
            ),
        }
    height, width = reference.shape
    return {"caption": frame.caption, "width": width, "height": height, "pictures": pictures}


def map_picture(error: np.ndarray) -> Image.Image:
    """A FLIP map (H, W) in [0, 1] in the colours of magma, black for none."""
    from matplotlib import colormaps

    level = np.round(np.clip(error, 0, 1) * (MAP_LEVELS - 1)) / (MAP_LEVELS - 1)
    return Image.fromarray((255 * colormaps["magma"](level)[..., :3]).round().astype(np.uint8))
