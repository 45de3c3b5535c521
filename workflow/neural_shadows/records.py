"""The JSON files that jobs leave for later ones, checked for what is read of them.

Each function gives the file's whole content.

Raises:
    InputError: the file is missing; or it is not what it should be, and moved aside.
"""

from pathlib import Path
from typing import Annotated, Any

from pydantic import Field, FiniteFloat, TypeAdapter, ValidationError
from typing_extensions import TypedDict

from neural_shadows.broken import broken
from neural_shadows.files import read_json

_Numbers = Annotated[list[FiniteFloat], Field(min_length=1)]


class _Machine(TypedDict):
    cpu: str
    cores: int
    gpu: str | None


class _Mesh(TypedDict):
    name: str
    faces: int
    watertight: bool
    centre: Annotated[list[FiniteFloat], Field(min_length=3, max_length=3)]
    radius: FiniteFloat


class _Lpips(TypedDict):
    net: str
    trunk: str | None
    available: bool
    reason: str | None


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


class _DepthBias(TypedDict):
    depth_bias: FiniteFloat


def read_mesh_report(path: str | Path) -> dict[str, Any]:
    """What `prepare_mesh` wrote on a mesh."""
    return _read(path, _Mesh, "report on a mesh")


def read_lpips_choice(path: str | Path) -> dict[str, Any]:
    """What `find_lpips` wrote."""
    return _read(path, _Lpips, "file on LPIPS")


def read_training(path: str | Path) -> dict[str, Any]:
    """What `train` wrote on a training."""
    return _read(path, _Training, "record of a training")


def read_bias_search(path: str | Path) -> dict[str, Any]:
    """What `find_depth_biases` wrote, by experiment."""
    return _read(path, dict[str, _DepthBias], "file of depth biases")


def read_scene_times(path: str | Path) -> dict[str, Any]:
    """What `measure_frame_times` wrote on a scene."""
    return _read(path, _FrameTimes, "file of frame times")


def read_cost(path: str | Path) -> dict[str, Any]:
    """What `measure_cost` wrote on one size."""
    return _read(path, _Cost, "file of costs")


def _read(path: str | Path, kind: type, what: str) -> dict[str, Any]:
    record = read_json(path)
    try:
        TypeAdapter(kind).validate_python(record, strict=True)
    except ValidationError as error:
        first = error.errors(include_input=False, include_url=False)[0]
        key = ".".join(map(str, first["loc"]))
        problem = f"{key}: {first['msg']}" if key else first["msg"]
        raise broken(path, f"no {what} ({problem})") from error
    return record
