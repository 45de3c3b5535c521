"""Reading of mesh files in all formats."""

import gzip
import io
import json
import re
import zlib
from pathlib import Path

import numpy as np

from neural_shadows.errors import InputError
from neural_shadows.meshes.binary_ply import parse_binary_ply
from neural_shadows.meshes.formats import format_of
from neural_shadows.meshes.obj_file import parse_obj

# Compression of glTF data, which trimesh reads as zeros.
_COMPRESSED = {"KHR_draco_mesh_compression", "EXT_meshopt_compression"}


def read_mesh(path: str | Path) -> tuple[np.ndarray, np.ndarray]:
    """Read a mesh file as triangles.

    Larger polygons become triangles. Scene graphs are flattened, with every instance transformed. Only
    positions and faces are used, and no other file (material, texture) is opened.

    Args:
        path: `.ply`, `.obj`, `.stl` or `.glb`, each also followed by `.gz`.

    Returns:
        Vertices (V, 3) float64 in the file's unit, faces (F, 3) int64 with indices into them.

    Raises:
        InputError: the file is missing, empty, damaged or without triangles, has an unknown suffix, or
            faces with invalid vertex indices.
    """
    kind = format_of(path)
    data = mesh_bytes(path)
    try:
        vertices, faces = _parse(data, kind)
        _check_indices(faces, len(vertices))
    except Exception as error:  # damaged files raise errors of many types
        reason = " ".join(str(error).split())[:200] or type(error).__name__
        raise InputError(
            f"mesh {path}: cannot be read as {kind.upper()} ({reason}): damaged, truncated or "
            "an unusual variant. Export it again, as triangles"
        ) from error
    if len(faces) == 0:
        raise InputError(
            f"mesh {path}: has no triangles (a point cloud, or a truncated file?). "
            "Give a triangle mesh"
        )
    return vertices, faces


def mesh_bytes(path: str | Path) -> bytes:
    """Content of a mesh file, decompressed if it ends in `.gz`.

    Raises:
        InputError: the file is missing, empty or damaged.
    """
    path = Path(path)
    try:
        data = path.read_bytes()
        if path.name.lower().endswith(".gz") and data:
            data = gzip.decompress(data)
    except (OSError, EOFError, zlib.error) as error:
        reason = getattr(error, "strerror", None) or error
        raise InputError(f"mesh {path}: cannot be read ({reason})") from error
    if not data:
        raise InputError(f"mesh {path}: is empty. Copy or export it again")
    return data


def _parse(data: bytes, kind: str) -> tuple[np.ndarray, np.ndarray]:
    if kind == "obj":
        return parse_obj(data)
    if kind == "ply" and (mesh := parse_binary_ply(data)):
        return mesh
    return _parse_with_trimesh(data, kind)


def _parse_with_trimesh(data: bytes, kind: str) -> tuple[np.ndarray, np.ndarray]:
    """Positions and faces of the other formats, scenes flattened."""
    import trimesh  # loading takes up to 0.8 s, needless for prepared meshes

    if kind == "ply":
        _check_ply(data)
    if kind == "glb":
        _check_glb(data)
    # `fix_texture` would duplicate vertices of a PLY at texture seams.
    scene = trimesh.load_scene(
        io.BytesIO(data), file_type=kind, process=False, skip_materials=True, fix_texture=False
    )
    meshes = [part for part in scene.geometry.values() if isinstance(part, trimesh.Trimesh)]
    if not meshes:
        return np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int64)
    # Part by part: in the joined mesh, an index past one part's end is a vertex of the next.
    for mesh in meshes:
        _check_indices(mesh.faces, len(mesh.vertices))
    # Flattening copies: 5 s for 2 million triangles.
    if kind == "glb" or len(meshes) > 1:
        mesh = scene.to_mesh()
    if len(mesh.faces) and mesh.vertices.shape[1:] != (3,):
        raise ValueError(f"its positions have {mesh.vertices.shape[1]} coordinates")
    return np.array(mesh.vertices, dtype=np.float64), np.array(mesh.faces, dtype=np.int64)


def _check_ply(data: bytes) -> None:
    """Refuse truncated ASCII files, accepted by trimesh."""
    header, _, body = data.partition(b"end_header")
    if re.search(rb"^format ascii", header, re.MULTILINE):
        expected = sum(map(int, re.findall(rb"^element \S+ (\d+)", header, re.MULTILINE)))
        rows = len(body.split(b"\n")) - 2 + (not body.endswith(b"\n"))
        if rows < expected:
            raise ValueError(f"{rows:,} rows instead of the header's {expected:,}")


def _check_glb(data: bytes) -> None:
    """Refuse compressed data, read as zeros by trimesh."""
    tree = json.loads(data[20 : 20 + int.from_bytes(data[12:16], "little")])
    if compressed := _COMPRESSED.intersection(tree.get("extensionsRequired", [])):
        raise ValueError(f"its data is compressed ({', '.join(compressed)}): export it without")


def _check_indices(faces: np.ndarray, vertices: int) -> None:
    """Refuse faces (F, 3) with invalid vertex indices."""
    invalid = np.flatnonzero(((faces < 0) | (faces >= vertices)).any(axis=1))
    if len(invalid):
        raise ValueError(
            f"face {invalid[0]} (counted from 0) has vertices {faces[invalid[0]].tolist()} of {vertices}"
        )
