"""Frame times as `measure_frame_times` wrote them."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from pydantic import FiniteFloat
from typing_extensions import TypedDict

from neural_shadows.files.records import _Numbers, _read
from neural_shadows.running.hardware import _Machine


class _Times(TypedDict):
    ms: _Numbers


class _FrameTimes(TypedDict):
    scene: str
    width: int
    height: int
    views: int
    repeats: int
    warm_up: int
    device: str
    precision: str
    machine: _Machine
    sphere_rays: FiniteFloat
    methods: dict[str, _Times]
    rays_per_second: dict[str, _Numbers]


def read_scene_times(path: str | Path) -> dict[str, Any]:
    """What `measure_frame_times` wrote on a scene."""
    return _read(path, _FrameTimes, "file of frame times")


def read_frame_times(paths: Sequence[Path]) -> dict[str, dict[str, Any]]:
    """What `measure_frame_times` wrote, by scene.

    Raises:
        InputError: a file is missing or not whole.
    """
    return {times["scene"]: times for times in map(read_scene_times, paths)}
