"""Soft frames side by side: pictures by two methods under a divider."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from matplotlib.colors import to_rgb
from PIL import Image

from neural_shadows.evaluation.look import FALSE_SHADOW, LIGHT_LEAK
from neural_shadows.evaluation.registry import is_network, look_of
from neural_shadows.frames.frame_set import FrameSetPart
from neural_shadows.metrics.registry import metrics
from neural_shadows.reports.data.frame_errors import FULL
from neural_shadows.reports.data.lights import light_sizes
from neural_shadows.reports.data.method_look import LOOKS, REFERENCE
from neural_shadows.reports.data.soft_pictures import SoftPictures, read_pictures
from neural_shadows.reports.page.blocks import lossy_uri

# 10 KB of a frame of 512 × 256 on average, 17 without loss in 64 levels. 99 % of its pixels are at most
# 0.024 off, and the least error shown is larger.
QUALITY = 50  # of 80 they take 1.7 times the bytes
SHADES = 8  # of an error's colour: none below 0.03
RULE = (
    "Of soft shadows the first test frame of a scene is shown, whatever its errors, under the least light "
    "of its frame set, the middle one and the largest. Surfaces are grey, lit by the light and faintly by the "
    "sky. MSE is the mean squared error of visibility in this frame; tables have that of all test "
    "frames."
)


class _Scene(NamedTuple):
    name: str
    sizes: Sequence[str]  # of its lights
    pictures: SoftPictures


def soft_comparisons(
    parts: Sequence[Path], answers: Sequence[Path], shown: Sequence[Mapping[str, Any]]
) -> list[dict[str, Any]]:
    """Data for the page's script, by table: shading of scenes, visibility by light and method.

    Args:
        parts: of frame sets, see `FrameSetPart`; answers: of methods, in folders of frame sets.
        shown: scenes: `table` and its `title`, `frame_set`, `scene`, `labels` of methods, and `radii`,
            counted from 0.

    Raises:
        InputError: a file is not whole.
    """
    parts_by_scene = {(path.parent.parent.name, path.parent.name): path for path in parts}
    answered = {(path.parents[1].name, path.stem): path for path in answers}
    scenes: dict[str, list[_Scene]] = {}
    names = {REFERENCE: f"{LOOKS[REFERENCE].symbol} Reference"}
    for one in shown:
        frame_set, labels = one["frame_set"], one["labels"]
        if part := parts_by_scene.get((frame_set, one["scene"])):
            names |= {method: f"{look_of(method).symbol} {labels[method]}" for method in labels}
            paths = {m: answered[frame_set, m] for m in labels if (frame_set, m) in answered}
            sizes = light_sizes(FrameSetPart(part).about)
            scene = _Scene(
                one["scene"],
                [sizes[k] for k in one["radii"]],
                read_pictures(part, paths, one["radii"]),
            )
            scenes.setdefault(one["table"], []).append(scene)
    titles = {one["table"]: one["title"] for one in shown}
    comparisons = (_comparison(table, titles[table], names, scenes[table]) for table in scenes)
    return [data for data in comparisons if len(data["methods"]) > 1]


def _comparison(
    table: str, title: str, names: Mapping[str, str], scenes: Sequence[_Scene]
) -> dict[str, Any]:
    first = scenes[0].pictures
    methods = [
        method
        for method in first.answers
        if all(method in scene.pictures.answers for scene in scenes)
    ]
    worst, best = _first_pair([scene.pictures for scene in scenes], methods)
    return {
        # The prefix tells a table from a scene of the same name.
        "name": f"soft-{table}",
        "title": title,
        "rule": RULE,
        "soft": True,
        "methods": [{"key": key, "name": names[key]} for key in (REFERENCE, *methods)],
        "left": worst,
        "right": best,
        "lights": [
            {"name": name, "size": size} for name, size in zip(first.lights, scenes[0].sizes)
        ],
        "errors": {"full": FULL, "shades": SHADES}
        | {"dark": _levels_of(FALSE_SHADOW), "bright": _levels_of(LIGHT_LEAK)},
        "views": [_view(scene, methods) for scene in scenes],
    }


def _first_pair(pictures: Sequence[SoftPictures], methods: Sequence[str]) -> tuple[str, str]:
    """The method of most error, and the network of least, or else the method."""

    def total(method: str) -> float:
        return sum(one.mse(method, k) for one in pictures for k in range(len(one.lights)))

    best = min(methods, key=lambda one: (not is_network(one), total(one)), default=REFERENCE)
    others = [method for method in methods if method != best]
    return max(others, key=total, default=REFERENCE), best


def _view(scene: _Scene, methods: Sequence[str]) -> dict[str, Any]:
    pictures = scene.pictures
    height, width = pictures.valid.shape
    lights = []
    for k in range(len(pictures.lights)):
        of_light = {REFERENCE: {"visibility": _picture(pictures.exact[k]), "scores": ""}}
        for method in methods:
            of_light[method] = {
                "visibility": _picture(pictures.answers[method][k]),
                "scores": metrics()["mse"].score(pictures.mse(method, k)),
            }
        lights.append(of_light)
    return {
        "caption": scene.name,
        "width": width,
        "height": height,
        "direct": _picture(pictures.shading.direct),
        "sky": _picture(pictures.shading.sky),
        "lights": lights,
    }


def _picture(image: np.ndarray) -> str:
    """An image (H, W) in [0, 1] within the page."""
    return lossy_uri(Image.fromarray(np.round(255 * image).astype(np.uint8)), QUALITY)


def _levels_of(colour: str) -> list[int]:
    return [round(255 * share) for share in to_rgb(colour)]
