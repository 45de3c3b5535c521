"""The distance field of one object of a scene: fitted, stored."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import fields
from hashlib import sha256
from pathlib import Path

import numpy as np
import trimesh

from neural_shadows.errors import InputError
from neural_shadows.files.whole_files import whole_file
from neural_shadows.meshes.prepared_mesh import PreparedMesh, with_normals
from neural_shadows.representations.distance_bricks.field_marching import BRICK
from neural_shadows.representations.shadow_field.fitted_bricks import fitted_bricks
from neural_shadows.representations.shadow_field.shadow_field import ShadowField

MOST = 256  # cells along an axis
_MARGIN = 1.02  # of an object's sphere, so that its surface is inside the grid


def fitted_field(mesh: PreparedMesh, cell: float) -> ShadowField | None:
    """The field of an object in place; None of an open one.

    Its cells are this wide if `MOST` allows. An open mesh has no inside.
    """
    merged = _merged(mesh)
    # 4 faces an edge where two parts of an object touch.
    if np.any(np.bincount(merged.edges_unique_inverse) % 2):
        return None
    centre = (mesh.vertices.min(0) + mesh.vertices.max(0)).astype(np.float32) / 2
    reach = np.linalg.norm(mesh.vertices - centre, axis=1).max()
    radius = np.float32(_MARGIN * reach)
    wanted = int(np.ceil(2 * radius / cell / BRICK)) * BRICK
    resolution = int(np.clip(wanted, 8 * BRICK, MOST))
    unit = with_normals((merged.vertices - centre) / radius, merged.faces)
    bricks = fitted_bricks(unit, resolution, sheet=False)
    return ShadowField(centre.astype(np.float64), float(radius), *bricks)


def _merged(mesh: PreparedMesh) -> trimesh.Trimesh:
    """The mesh with merged vertices: generated objects have one a face."""
    return trimesh.Trimesh(mesh.vertices, mesh.faces, process=True)


def field_key(mesh: PreparedMesh, cell: float) -> str:
    """A digest of a field's mesh, position and cell size."""
    content = mesh.vertices.tobytes() + mesh.faces.tobytes() + np.float64(cell).tobytes()
    return sha256(content).hexdigest()


def write_fields(path: Path, fields_by_key: Mapping[str, ShadowField]) -> None:
    """Write fields by their keys, one compressed npz."""
    arrays = {
        f"{key}.{attribute.name}": getattr(field, attribute.name)
        for key, field in fields_by_key.items()
        for attribute in fields(ShadowField)
    }
    with whole_file(path) as part, part.open("wb") as file:
        np.savez_compressed(file, **arrays)


class StoredFields:
    """A file of `write_fields`, read field by field.

    Raises:
        InputError: the file is missing or damaged, here or when a field is read.
    """

    def __init__(self, path: Path):
        self._path = path
        with self._opened() as arrays:
            self._keys = {name.partition(".")[0] for name in arrays.files}

    def get(self, key: str) -> ShadowField | None:
        """The field of a key, or None."""
        if key not in self._keys:
            return None
        with self._opened() as arrays:
            stored = {each.name: arrays[f"{key}.{each.name}"] for each in fields(ShadowField)}
        return ShadowField(**stored | {"radius": float(stored["radius"])})

    @contextmanager
    def _opened(self) -> Iterator[np.lib.npyio.NpzFile]:
        try:
            with self._path.open("rb") as file, np.load(file, allow_pickle=False) as arrays:
                yield arrays
        except Exception as error:  # zipfile and zlib raise many kinds
            raise InputError(
                f"{self._path}: damaged ({error}). Delete it and run again."
            ) from error
