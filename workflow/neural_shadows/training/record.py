"""The record of a training as `train` wrote it."""

from pathlib import Path
from typing import Any

from pydantic import FiniteFloat
from typing_extensions import TypedDict

from neural_shadows.files.records import _read
from neural_shadows.running.hardware import _Machine


class _Network(TypedDict):
    encoding: str


class _Settings(TypedDict):
    steps: int
    batch_size: int
    learning_rate: FiniteFloat
    schedule: str
    device: str
    precision: str


class _Training(TypedDict):
    name: str
    network: _Network
    training: _Settings
    parameters: int
    samples: int
    seconds: FiniteFloat
    machine: _Machine
    threads: int


def read_training(path: str | Path) -> dict[str, Any]:
    """What `train` wrote on a training."""
    return _read(path, _Training, "record of a training")
