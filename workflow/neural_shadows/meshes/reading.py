"""Mesh files of all formats."""

import io
from pathlib import Path

import numpy as np
import trimesh

from neural_shadows.errors import InputError
from neural_shadows.files.gzip_file import unpack
from neural_shadows.meshes.format_checks import check_glb, check_indices, check_ply, check_stl
from neural_shadows.meshes.obj_file import parse_obj

FORMATS = ("ply", "obj", "stl", "glb")

# A small file can decompress to more than memory holds; the largest scans stay below this.
MAX_BYTES = 4 * 2**30


def read_mesh(path: str | Path) -> tuple[np.ndarray, np.ndarray]:
    """Read a triangle mesh as its file has it; larger polygons become triangles.

    Scene graphs are flattened, with every instance where its transforms put it. Only
    positions and faces are used, and no other file (material, texture) is opened.

    Args:
        path: `.ply`, `.obj`, `.stl` or `.glb`, each also with `.gz` behind it.

    Returns:
        Vertices (V, 3) float64 in the file's unit, faces (F, 3) int64 with indices into them.

    Raises:
        InputError: no such file, an unknown suffix, or a file that is empty, damaged, too
            large, or without triangles, or whose faces name vertices that it does not have.
    """
    path = Path(path)
    if path.is_dir():
        raise InputError(f"mesh {path}: is a folder; give the mesh file in it")
    if not path.exists():
        raise InputError(f"mesh {path}: no such file; check the path")
    if not path.is_file():  # a pipe would be waited for
        raise InputError(f"mesh {path}: is no regular file; give a mesh file")
    suffixes = path.name.lower().removesuffix(".gz").rsplit(".", 1)
    kind = suffixes[-1]
    if len(suffixes) < 2 or kind not in FORMATS:
        allowed = ", ".join(f".{suffix}" for suffix in FORMATS)
        raise InputError(
            f"mesh {path}: the format is not known by this suffix; "
            f"give one of {allowed} (also with .gz behind it)"
        )
    data = _read_bytes(path)
    try:
        vertices, faces = parse_obj(data) if kind == "obj" else _parse_with_trimesh(data, kind)
    except Exception as error:  # whatever a damaged file makes the readers raise
        reason = " ".join(str(error).split())[:200] or type(error).__name__
        raise InputError(
            f"mesh {path}: cannot be read as {kind.upper()} ({reason}); it is damaged, truncated, "
            "too large or an unusual variant: export it again, as triangles"
        ) from error
    if len(faces) == 0:
        raise InputError(
            f"mesh {path}: no triangles in it (a point cloud, or a truncated file?); "
            "give a triangle mesh"
        )
    return vertices, faces


def _read_bytes(path: Path) -> bytes:
    """Content of a file, decompressed if it ends in `.gz`, up to `MAX_BYTES`."""
    try:
        if path.name.lower().endswith(".gz"):
            data = unpack(path, MAX_BYTES)
        elif path.stat().st_size > MAX_BYTES:
            raise ValueError(f"has more than {MAX_BYTES:,} bytes")
        else:
            data = path.read_bytes()
    except ValueError as error:
        raise InputError(f"mesh {path}: {error}; copy it again, or give a smaller mesh") from error
    except OSError as error:
        raise InputError(f"mesh {path}: cannot be read ({error.strerror or error})") from error
    if not data:
        raise InputError(f"mesh {path}: is empty; copy or export it again")
    return data


def _parse_with_trimesh(data: bytes, kind: str) -> tuple[np.ndarray, np.ndarray]:
    """Positions and faces of the other formats, scenes flattened."""
    {"ply": check_ply, "stl": check_stl, "glb": check_glb}[kind](data)
    # Without `fix_texture` the vertices of a PLY are not copied at texture seams.
    scene = trimesh.load_scene(
        io.BytesIO(data), file_type=kind, process=False, skip_materials=True, fix_texture=False
    )
    # Part by part: once joined, an index past the end of one part is a vertex of the next.
    for part in scene.geometry.values():
        if isinstance(part, trimesh.Trimesh):
            check_indices(part.faces, len(part.vertices))
    mesh = scene.to_mesh()
    if len(mesh.faces) and mesh.vertices.shape[1:] != (3,):
        raise ValueError(f"its positions have {mesh.vertices.shape[1]} coordinates")
    return np.array(mesh.vertices, dtype=np.float64), np.array(mesh.faces, dtype=np.int64)
