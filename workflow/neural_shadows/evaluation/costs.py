"""The sizes over which costs are measured."""

from pathlib import Path
from typing import Any

from pydantic import FiniteFloat
from typing_extensions import TypedDict

from neural_shadows.files.records import _read
from neural_shadows.running.hardware import _Machine


class _StageCost(TypedDict):
    stage: str
    seconds: FiniteFloat
    bytes: FiniteFloat
    peak_bytes: FiniteFloat


class _Cost(TypedDict):
    over: str
    size: int
    stages: list[_StageCost]
    machine: _Machine
    threads: int


def read_cost(path: str | Path) -> dict[str, Any]:
    """What `measure_cost` wrote on one size."""
    return _read(path, _Cost, "file of costs")


# Which stages each is a size of, in the order in which one needs the files of the other.
STAGES = {
    "subdivisions": ("mesh", "rays", "labels", "evaluation"),
    "samples": ("rays", "labels", "training"),
    "width": ("training",),
    "views": ("evaluation",),
    "frame_width": ("evaluation",),
}
