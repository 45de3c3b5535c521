"""Networks of whole frames: what each is trained on."""

from collections.abc import Iterable
from typing import Any

from neural_shadows.layout import frame_sets
from neural_shadows.layout.layout import Layout

_KEYS = ("network", "training", "scenes", "seed")


def training_files(layout: Layout, experiment: str) -> dict[str, Any]:
    """The parts that an experiment trains on and those that it is validated on, with their arrays;
    and the trunk of its perceptual distance.
    """
    settings = layout.entry("screen_experiments", experiment)
    found = {
        use: [
            part
            for scene in settings["scenes"]
            for part in frame_sets.parts(layout, scene, settings["frame_set"], use)
        ]
        for use in ("train", "validation")
    }
    beside = frame_sets.arrays([*found["train"], *found["validation"]])
    return {**found, "beside": beside, "trunk": settings["trunk"] or []}


def training_settings(layout: Layout, experiment: str) -> dict[str, Any]:
    """What `train_screen` is told beside its files."""
    settings = layout.entry("screen_experiments", experiment)
    return {key: settings[key] for key in _KEYS}


def forms(layout: Layout, experiments: Iterable[str]) -> set[str]:
    """The forms of the networks of some experiments."""
    return {layout.entry("screen_experiments", one)["network"]["form"] for one in experiments}
