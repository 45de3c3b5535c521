"""Screen-space networks: training files and settings."""

from collections.abc import Iterable
from typing import Any

from neural_shadows.layout import frame_sets
from neural_shadows.layout.layout import Layout

_KEYS = ("network", "training", "scenes", "seed")


def training_files(layout: Layout, experiment: str) -> dict[str, Any]:
    """Training and validation parts with arrays, and pretrained weights."""
    settings = layout.entry("screen_experiments", experiment)
    parts = {
        use: [
            part
            for scene in settings["scenes"]
            for part in frame_sets.parts(layout, scene, settings["frame_set"], use)
        ]
        for use in ("train", "validation")
    }
    beside = frame_sets.arrays([*parts["train"], *parts["validation"]])
    return {**parts, "beside": beside, "trunk": settings["trunk"] or []}


def training_settings(layout: Layout, experiment: str) -> dict[str, Any]:
    """Arguments of `train_screen` besides files."""
    settings = layout.entry("screen_experiments", experiment)
    return {key: settings[key] for key in _KEYS}


def forms(layout: Layout, experiments: Iterable[str]) -> set[str]:
    """Forms of the networks of experiments."""
    return {layout.entry("screen_experiments", name)["network"]["form"] for name in experiments}
