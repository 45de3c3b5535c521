"""The stage that turns a mesh file into a clean mesh in its unit sphere [3.3.1]."""

from pathlib import Path
from typing import Any

import numpy as np
import trimesh

from neural_shadows.files.whole_files import sha256_of, whole_file, write_json
from neural_shadows.meshes.bounding_sphere import minimal_bounding_sphere
from neural_shadows.meshes.cleaning import clean_mesh
from neural_shadows.meshes.reading import read_mesh


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
