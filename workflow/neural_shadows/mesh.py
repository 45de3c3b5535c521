"""Triangle meshes: reading what users bring, cleaning it, and the move to normalised space."""

import io
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import trimesh
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree
from trimesh.grouping import unique_rows

from neural_shadows.bounding_sphere import minimal_bounding_sphere
from neural_shadows.errors import InputError
from neural_shadows.files import sha256_of, whole_file, write_json
from neural_shadows.gzip_file import unpack
from neural_shadows.mesh_checks import check_glb, check_indices, check_ply, check_stl
from neural_shadows.obj_file import parse_obj

FORMATS = ("ply", "obj", "stl", "glb")

# A small file can decompress to more than memory holds; the largest scans stay below this.
MAX_BYTES = 4 * 2**30

# Vertices closer than this share of the bounding box's diagonal are one vertex, and
# triangles lower than it are none. It is below the rounding of float32 (6e-8), in which
# rays are traced, and above that of float64 at an offset of 1e6 (1e-10).
MERGE_DISTANCE = 1e-8

# How far outside the unit sphere rounding may put a vertex of a prepared mesh.
_SPHERE_SLACK = 1e-4


@dataclass(frozen=True)
class PreparedMesh:
    """A clean mesh in normalised space: its minimal bounding sphere is the unit sphere.

    All normals have unit length and follow the winding of the faces.
    """

    vertices: np.ndarray
    """(V, 3) float32."""
    faces: np.ndarray
    """(F, 3) int32, indices into `vertices`, counter-clockwise seen from outside."""
    vertex_normals: np.ndarray
    """(V, 3) float32, mean of the adjacent face normals weighted by the angle at the vertex."""
    face_normals: np.ndarray
    """(F, 3) float32, geometric normals."""


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


def clean_mesh(
    vertices: np.ndarray, faces: np.ndarray, name: str
) -> tuple[np.ndarray, np.ndarray, dict[str, Any]]:
    """Make every vertex and face count once; open meshes stay as they are.

    Vertices within `MERGE_DISTANCE` of the bounding box's diagonal are merged (into the
    first of them), then faces of no height (relative to the same) and repeated faces (the
    same three vertices, whatever the winding) are dropped, then vertices of no face. Of a
    flap made of two opposite faces one stays, so its rim then counts as open (the Stanford
    dragon loses 1,489 faces, nearly all of them to such flaps). None of it depends on the
    unit or on an offset.

    Args:
        vertices: (V, 3) in any unit.
        faces: (F, 3) indices into them.
        name: what error messages call the mesh.

    Returns:
        Vertices (V', 3) float64 and faces (F', 3) int64 in their first order, and a report:
        the counts before and after, what was merged and dropped, and how closed the surface
        is (`watertight`: two faces at every edge; `open_edges`: edges of a single face;
        `non_manifold_edges`: edges of more than two; `bodies`: connected components).

    Raises:
        InputError: a NaN or infinite coordinate, or no face with an area.
    """
    source_vertices, source_faces = len(vertices), len(faces)
    vertices = np.asarray(vertices, dtype=np.float64)
    faces = np.asarray(faces, dtype=np.int64)
    bad = np.flatnonzero(~np.isfinite(vertices).all(axis=1))
    if len(bad):
        x, y, z = vertices[bad[0]]
        raise InputError(
            f"mesh {name}: vertex {bad[0]} (counted from 0) is ({x}, {y}, {z}), and "
            f"{len(bad)} in all have a coordinate that is not a finite number; mend the mesh"
        )

    vertices, faces = _drop_unreferenced(vertices, faces)
    unreferenced = source_vertices - len(vertices)
    # About the origin and with a diagonal of 1, so that tolerances are relative and an
    # offset costs no digits of a product.
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    diagonal = np.linalg.norm(high - low)
    if not 0 < diagonal < np.inf:
        raise InputError(
            f"mesh {name}: its bounding box has the diagonal {diagonal:g}; give a mesh with a size"
        )
    points = (vertices - (low + (high - low) / 2)) / diagonal

    first, group = _merge(points)
    vertices, points, faces = vertices[first], points[first], group[faces]
    merged = len(group) - len(first)

    kept = faces[_heights(points[faces]) > MERGE_DISTANCE]
    degenerate = len(faces) - len(kept)
    if len(kept) == 0:
        raise InputError(
            f"mesh {name}: all {source_faces} faces have zero area; give a mesh with a surface"
        )
    unique, _ = unique_rows(np.sort(kept, axis=1), keep_order=True)
    faces = kept[unique]

    joined = len(vertices)
    vertices, faces = _drop_unreferenced(vertices, faces)
    report = {
        "source_vertices": source_vertices,
        "source_faces": source_faces,
        "vertices": len(vertices),
        "faces": len(faces),
        "merged_vertices": merged,
        "unreferenced_vertices": unreferenced + joined - len(vertices),
        "degenerate_faces": degenerate,
        "duplicate_faces": len(kept) - len(faces),
        **_topology(faces),
    }
    return vertices, faces, report


def prepare_mesh(source: Path, mesh_ply: Path, mesh_json: Path, *, name: str) -> dict[str, Any]:
    """Read, clean and normalise a mesh: x' = (x - c) / r, its minimal bounding sphere [3.3.1].

    Args:
        source: any mesh that `read_mesh` reads.
        mesh_ply: the mesh in normalised space, as binary float32 PLY.
        mesh_json: the report: `name`, `source` (file name) and its `sha256`, `centre` (c) and
            `radius` (r) in the source's unit, and the report of `clean_mesh`.
        name: what tables call the mesh; messages name its file.

    Returns:
        The content of `mesh_json`.

    Raises:
        InputError: as `read_mesh` and `clean_mesh`; nothing is written then.
    """
    source = Path(source)
    vertices, faces, report = clean_mesh(*read_mesh(source), str(source))
    centre, radius = minimal_bounding_sphere(vertices)
    normalised = ((vertices - centre) / radius).astype(np.float32)
    # float32 can bring distinct vertices together (its spacing at 1 is 6e-8), so what is
    # written is cleaned once more.
    normalised, faces, again = clean_mesh(normalised, faces, str(source))
    dropped = ("merged_vertices", "unreferenced_vertices", "degenerate_faces", "duplicate_faces")
    report = (
        {
            "name": name,
            "source": source.name,
            "sha256": sha256_of(source),
            "centre": centre.tolist(),
            "radius": radius,
        }
        | report
        | again
        | {key: report[key] for key in ("source_vertices", "source_faces")}
        | {key: report[key] + again[key] for key in dropped}
    )
    with whole_file(mesh_ply) as part:
        mesh = trimesh.Trimesh(normalised, faces, process=False)
        part.write_bytes(mesh.export(file_type="ply"))
        write_json(mesh_json, report)
    return report


def read_prepared(mesh_ply: str | Path) -> PreparedMesh:
    """Read a mesh that `prepare_mesh` wrote, and compute its normals.

    Raises:
        InputError: as `read_mesh`; or the mesh is not in normalised space, or not clean.
    """
    vertices, faces = read_mesh(mesh_ply)
    reach = np.linalg.norm(vertices, axis=1).max()
    if not reach <= 1 + _SPHERE_SLACK:
        raise InputError(
            f"mesh {mesh_ply}: a vertex is {reach:g} from the origin, outside the unit sphere; "
            "it was not prepared by this pipeline: delete it and run again"
        )
    corners = vertices[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    if not lengths.all():
        raise InputError(
            f"mesh {mesh_ply}: face {lengths.argmin()} has no area; "
            "it was not prepared by this pipeline: delete it and run again"
        )
    normals /= lengths
    return PreparedMesh(
        vertices=vertices.astype(np.float32),
        faces=faces.astype(np.int32),
        vertex_normals=_vertex_normals(corners, faces, normals, len(vertices)).astype(np.float32),
        face_normals=normals.astype(np.float32),
    )


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


def _drop_unreferenced(vertices: np.ndarray, faces: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Vertices that some face names, in their order, and the faces with the new indices."""
    used = np.zeros(len(vertices), dtype=bool)
    used[faces] = True
    return vertices[used], (np.cumsum(used) - 1)[faces]


def _merge(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Group points that are within `MERGE_DISTANCE` of each other, chains included.

    Returns:
        Index of each group's first point (G,) and the group of each point (n,).
    """
    # First by cells that are small enough for all in one to be that close: a tree alone
    # would list n^2 / 2 pairs where n points coincide.
    cells = np.round(points / (MERGE_DISTANCE / np.sqrt(3))).astype(np.int64)
    first, cell = unique_rows(cells, keep_order=True)
    pairs = cKDTree(points[first]).query_pairs(MERGE_DISTANCE, output_type="ndarray")
    group = _components(pairs, len(first))[cell]
    _, first = np.unique(group, return_index=True)
    return first, group


def _components(pairs: np.ndarray, count: int) -> np.ndarray:
    """Label (count,) of the connected component of each node, given (n, 2) linked pairs."""
    links = coo_array((np.ones(len(pairs), dtype=bool), pairs.T), shape=(count, count))
    return connected_components(links, directed=False)[1]


def _heights(corners: np.ndarray) -> np.ndarray:
    """Height (F,) over the longest side of triangles (F, 3, 3); 0 where all corners coincide."""
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    doubled_areas = np.linalg.norm(normals, axis=1)
    return np.divide(doubled_areas, longest, out=np.zeros_like(longest), where=longest > 0)


def _topology(faces: np.ndarray) -> dict[str, Any]:
    """How closed a surface is, given its faces (F, 3) without unreferenced vertices."""
    sides = np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    first, edge = unique_rows(sides)
    uses = np.bincount(edge)
    return {
        "watertight": bool((uses == 2).all()),
        "open_edges": int((uses == 1).sum()),
        "non_manifold_edges": int((uses > 2).sum()),
        "bodies": int(_components(sides[first], int(faces.max()) + 1).max()) + 1,
    }


def _vertex_normals(
    corners: np.ndarray, faces: np.ndarray, face_normals: np.ndarray, count: int
) -> np.ndarray:
    """Unit normals (count, 3): the mean of the adjacent faces', weighted by their angle.

    By angle and not by area or count, so that they do not depend on the triangulation
    (Thürmer and Wüthrich 1998). trimesh computes the same, but takes faces whose doubled
    area is below 2e-14 for degenerate, and such faces do occur in normalised space.
    """
    after = np.roll(corners, -1, axis=1) - corners
    before = np.roll(corners, 1, axis=1) - corners
    sines = np.linalg.norm(np.cross(after, before), axis=2)
    angles = np.arctan2(sines, (after * before).sum(axis=2))
    sums = np.zeros((count, 3))
    np.add.at(sums, faces, angles[..., None] * face_normals[:, None])
    # Where faces cancel (a fold, or sheets of opposite winding) one of them stands for all.
    lengths = np.linalg.norm(sums, axis=1)
    cancelled = lengths < 1e-6
    any_face = np.zeros(count, dtype=np.int64)
    any_face[faces] = np.arange(len(faces))[:, None]
    sums[cancelled] = face_normals[any_face[cancelled]]
    return sums / np.linalg.norm(sums, axis=1, keepdims=True)
