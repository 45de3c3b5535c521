"""Frames side by side: pictures of a frame by two methods under a divider."""

from collections import Counter
from collections.abc import Callable, Collection, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from neural_shadows.evaluation.answers import name_of, read_answer
from neural_shadows.evaluation.metric_files import read_view_metrics
from neural_shadows.evaluation.registry import is_network
from neural_shadows.evaluation.registry import look_of as look_of_method
from neural_shadows.frames.frame_set import FrameSetPart
from neural_shadows.metrics.kinds.flip import flip_map
from neural_shadows.metrics.registry import metrics as metrics_by_key
from neural_shadows.reports.data import chosen_views
from neural_shadows.reports.data.frame_errors import error_layer, graded_layer
from neural_shadows.reports.data.frames import Frame, read_frames
from neural_shadows.reports.data.inputs import by_folder
from neural_shadows.reports.data.lights import light_names
from neural_shadows.reports.data.method_look import LOOKS, REFERENCE, look_of
from neural_shadows.reports.page.blocks import webp_uri
from neural_shadows.settings.records import Row

MAP_LEVELS = 64  # of a FLIP map: steps of 0.016, and files a third as large as of 256
REFERENCE_NAME = f"{LOOKS[REFERENCE].symbol} Reference"
SCORES = ("mse", "lpips", "psnr", "flip")
SOFT_RULE = (
    "Of soft shadows the first test frame of a scene is shown, whatever its errors: the visibility of "
    "each pixel. MSE is the mean squared error of visibility in this frame; tables have that of all "
    "test frames."
)
NUMBER = 0  # of a part's frames, the one whose answers are kept

# From a method's image and the reference (H, W) in [0, 1], the script's layers over the reference
# (`errors`) or in its place (`map`), by name.
Layers = Callable[[np.ndarray, np.ndarray], dict[str, Image.Image]]


def frame_comparisons(
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
        data = _comparison(f"{scene}: {meshes.get(scene, '')}", frames, names, _hard_layers)
        # The trained network of least error first, or else the method.
        trained = [key for key, row in methods.items() if row["trained"]]
        data |= {"name": scene, "left": _errs_least(frames, "flip", trained)}
        comparisons.append(data | {"rule": chosen_views.RULE, "flip": True})
    return comparisons


def soft_comparisons(
    parts: Sequence[Path], answers: Sequence[Path], pictures: Sequence[Mapping[str, Any]]
) -> list[dict[str, Any]]:
    """Data for the page's script: frames by light and errors, by table.

    A method's picture under one light takes 40 to 65 KB of the page at 512 × 256.

    Args:
        parts: of frame sets, see `FrameSetPart`; answers: of methods, in folders of frame sets.
        pictures: of scenes: `table` and its `title`, `frame_set`,
            `scene`, `labels` of methods, and `radii`, counted from 0.

    Raises:
        InputError: a file is not whole.
    """
    scenes = {(one.parent.parent.name, one.parent.name): one for one in parts}
    answered = {(path.parents[1].name, path.stem): path for path in answers}
    frames: dict[str, list[Frame]] = {}
    names: dict[str, str] = {}
    for one in pictures:
        frame_set = one["frame_set"]
        if part := scenes.get((frame_set, one["scene"])):
            labels = one["labels"]
            names |= {m: f"{look_of_method(m).symbol} {label}" for m, label in labels.items()}
            files = {m: answered[frame_set, m] for m in labels if (frame_set, m) in answered}
            frames.setdefault(one["table"], []).extend(_soft_frames(part, files, one["radii"]))
    titles = {one["table"]: one["title"] for one in pictures}
    networks = list(filter(is_network, names))
    comparisons = []
    for table, shown in frames.items():
        if len(_shared_methods(shown)) < 2:
            continue
        data = _comparison(titles[table], shown, names, _soft_layers)
        # The prefix tells a table from a scene of the same name.
        data |= {"name": f"soft-{table}", "left": _errs_least(shown, "mse", networks)}
        comparisons.append(data | {"rule": SOFT_RULE, "flip": False})
    return comparisons


def _soft_frames(part: Path, answers: Mapping[str, Path], radii: Sequence[int]) -> list[Frame]:
    """The first frame of a part by methods, under each light."""
    opened = FrameSetPart(part)
    scene, lights = part.parent.name, light_names(opened.about)
    valid = np.asarray(opened.valid[NUMBER, 0])
    frames = []
    for k in radii:
        target = opened.targets[NUMBER, k].astype(np.float32)
        frame = Frame((scene, k), f"{scene}, {lights[k]}", {REFERENCE: target})
        for method, path in answers.items():
            image = np.where(valid, read_answer(path, name_of(part, k)), target)
            frame.images[method] = image
            square = np.square(image - target)[valid].mean()
            frame.scores[method] = {"mse": float(square)}
        frames.append(frame)
    return frames


def _comparison(
    title: str, frames: Sequence[Frame], names: Mapping[str, str], layers: Layers
) -> dict[str, Any]:
    """Frames and methods to choose among; `names` of methods, with their symbols."""
    methods, names = _shared_methods(frames), {REFERENCE: REFERENCE_NAME, **names}
    return {
        "title": title,
        "methods": [{"key": key, "name": names.get(key, key)} for key in methods],
        "right": REFERENCE,
        "views": [_view(frame, methods, layers) for frame in frames],
    }


def _shared_methods(frames: Sequence[Frame]) -> list[str]:
    """Methods of all frames."""
    return [key for key in frames[0].images if all(key in frame.images for frame in frames)]


def _errs_least(frames: Sequence[Frame], metric: str, networks: Collection[str]) -> str:
    """The network of least error in the frames, or else the method."""

    def rank(method: str) -> tuple[bool, float]:
        return method not in networks, sum(frame.scores[method][metric] for frame in frames)

    methods = [method for method in _shared_methods(frames) if method != REFERENCE]
    return min(methods, key=rank, default=REFERENCE)


def _hard_layers(image: np.ndarray, reference: np.ndarray) -> dict[str, Image.Image]:
    return {
        "errors": Image.fromarray(error_layer(image, reference)),
        "map": map_picture(flip_map(image, reference)),
    }


def _soft_layers(image: np.ndarray, reference: np.ndarray) -> dict[str, Image.Image]:
    return {"errors": Image.fromarray(graded_layer(image, reference))}


def _view(frame: Frame, methods: Sequence[str], layers: Layers) -> dict[str, Any]:
    reference = frame.images[REFERENCE]
    pictures = {REFERENCE: {"scores": ""}}
    for method in methods:
        if method == REFERENCE:
            continue
        image, scores = frame.images[method], frame.scores[method]
        shown = {"change": Image.fromarray(change_layer(image, reference))}
        shown |= layers(image, reference)
        pictures[method] = {name: webp_uri(layer) for name, layer in shown.items()} | {
            "scores": ", ".join(
                metrics_by_key()[key].score(scores[key]) for key in SCORES if key in scores
            )
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
