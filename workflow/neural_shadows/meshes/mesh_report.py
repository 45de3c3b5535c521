"""The report on a mesh as `prepare_mesh` wrote it."""

from pathlib import Path
from typing import Annotated, Any

from pydantic import Field, FiniteFloat
from typing_extensions import TypedDict

from neural_shadows.files.records import _read


class _Mesh(TypedDict):
    name: str
    faces: int
    watertight: bool
    centre: Annotated[list[FiniteFloat], Field(min_length=3, max_length=3)]
    radius: FiniteFloat


def read_mesh_report(path: str | Path) -> dict[str, Any]:
    """What `prepare_mesh` wrote on a mesh."""
    return _read(path, _Mesh, "report on a mesh")
