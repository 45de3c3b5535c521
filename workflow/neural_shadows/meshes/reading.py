"""Mesh files of all formats, as users bring them."""

import gzip
import io
import json
import re
import zlib
from pathlib import Path

import numpy as np
import trimesh

from neural_shadows.errors import InputError
from neural_shadows.meshes.ascii_ply import parse_ascii_ply
from neural_shadows.meshes.formats import format_of
from neural_shadows.meshes.obj_file import parse_obj

# What glTF data can be compressed by; trimesh reads zeros in its place.
_COMPRESSED = {"KHR_draco_mesh_compression", "EXT_meshopt_compression"}


def read_mesh(path: str | Path) -> tuple[np.ndarray, np.ndarray]:
    """Read a triangle mesh as its file has it; larger polygons become triangles.

    Scene graphs are flattened, with every instance where its transforms put it. Only positions
    and faces are used, and no other file (material, texture) is opened.

    Args:
        path: `.ply`, `.obj`, `.stl` or `.glb`, each also with `.gz` behind it.

    Returns:
        Vertices (V, 3) float64 in the file's unit, faces (F, 3) int64 with indices into them.

    Raises:
        InputError: no such file, an unknown suffix, or a file that is empty, damaged or without
            triangles, or whose faces name vertices that it does not have.
    """
    kind = format_of(path)
    data = mesh_bytes(path)
    try:
        vertices, faces = _parse(data, kind)
        _check_indices(faces, len(vertices))
    except Exception as error:  # whatever a damaged file makes trimesh raise
        reason = " ".join(str(error).split())[:200] or type(error).__name__
        raise InputError(
            f"mesh {path}: cannot be read as {kind.upper()} ({reason}); it is damaged, truncated "
            "or an unusual variant: export it again, as triangles"
        ) from error
    if len(faces) == 0:
        raise InputError(
            f"mesh {path}: no triangles in it (a point cloud, or a truncated file?); "
            "give a triangle mesh"
        )
    return vertices, faces


def mesh_bytes(path: str | Path) -> bytes:
    """Content of a mesh file, decompressed if it ends in `.gz`.

    Raises:
        InputError: no such file, or it is empty or damaged.
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
        raise InputError(f"mesh {path}: is empty; copy or export it again")
    return data


def _parse(data: bytes, kind: str) -> tuple[np.ndarray, np.ndarray]:
    if kind == "obj":
        return parse_obj(data)
    if kind == "ply" and (found := parse_ascii_ply(data)) is not None:
        return found
    return _parse_with_trimesh(data, kind)


def _parse_with_trimesh(data: bytes, kind: str) -> tuple[np.ndarray, np.ndarray]:
    """Positions and faces of the other formats, scenes flattened."""
    if kind == "ply":
        _check_ply(data)
    if kind == "glb":
        _check_glb(data)
    # Without `fix_texture` the vertices of a PLY are not copied at texture seams.
    scene = trimesh.load_scene(
        io.BytesIO(data), file_type=kind, process=False, skip_materials=True, fix_texture=False
    )
    meshes = [part for part in scene.geometry.values() if isinstance(part, trimesh.Trimesh)]
    if not meshes:
        return np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int64)
    # Part by part: once joined, an index past the end of one part is a vertex of the next.
    for mesh in meshes:
        _check_indices(mesh.faces, len(mesh.vertices))
    # To flatten is to copy: 2 million triangles for 5 s.
    if kind == "glb" or len(meshes) > 1:
        mesh = scene.to_mesh()
    if len(mesh.faces) and mesh.vertices.shape[1:] != (3,):
        raise ValueError(f"its positions have {mesh.vertices.shape[1]} coordinates")
    return np.array(mesh.vertices, dtype=np.float64), np.array(mesh.faces, dtype=np.int64)


def _check_ply(data: bytes) -> None:
    """Refuse text with fewer rows than its header says, which trimesh takes for all."""
    header, _, body = data.partition(b"end_header")
    if re.search(rb"^format ascii", header, re.MULTILINE):
        said = sum(map(int, re.findall(rb"^element \S+ (\d+)", header, re.MULTILINE)))
        rows = len(body.split(b"\n")) - 2 + (not body.endswith(b"\n"))
        if rows < said:
            raise ValueError(f"{rows:,} rows where its header says {said:,}")


def _check_glb(data: bytes) -> None:
    """Refuse compressed data, for which trimesh reads zeros."""
    tree = json.loads(data[20 : 20 + int.from_bytes(data[12:16], "little")])
    if compressed := _COMPRESSED.intersection(tree.get("extensionsRequired", [])):
        raise ValueError(f"its data is compressed ({', '.join(compressed)}): export it without")


def _check_indices(faces: np.ndarray, vertices: int) -> None:
    """Refuse faces (F, 3) that name vertices which are not there."""
    bad = np.flatnonzero(((faces < 0) | (faces >= vertices)).any(axis=1))
    if len(bad):
        raise ValueError(
            f"face {bad[0]} (counted from 0) names vertices {faces[bad[0]].tolist()} of {vertices}"
        )
