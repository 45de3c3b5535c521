"""Reports on meshes."""

from pathlib import Path
from typing import Any

from neural_shadows.files.whole_files import read_json


def read_mesh_report(mesh_json: str | Path) -> dict[str, Any]:
    """Read the report of `prepare_mesh` on a mesh.

    Raises:
        InputError: the file is missing or not whole.
    """
    return read_json(mesh_json)
