"""Stage for clean meshes in their unit sphere [3.3.1]."""

import hashlib
from pathlib import Path

import trimesh

from neural_shadows.files.whole_files import sha256_of, whole_file, write_json
from neural_shadows.meshes.normalised import normalised
from neural_shadows.meshes.reading import mesh_bytes, read_mesh
from neural_shadows.meshes.thesis_meshes import is_thesis_mesh
from neural_shadows.running import progress
from neural_shadows.running.origin import describe_origin
from neural_shadows.running.stage import run_stage
from neural_shadows.settings.records import MeshSource


def prepare_mesh(
    source: Path, mesh_ply: Path, mesh_json: Path, mesh: MeshSource, name: str
) -> None:
    """Read, clean and normalise a mesh: x' = (x - c) / r.

    c and r are centre and radius of its minimal bounding sphere [3.3.1].

    Args:
        source: a mesh file for `read_mesh`.
        mesh_ply: the mesh in normalised space, as binary float32 PLY.
        mesh_json: the report: `name`, `source` (file name) and its `sha256`, `thesis_mesh`
            (`is_thesis_mesh`), `centre` (c) and `radius` (r) in the source's unit, the reports of
            `clean_mesh` and `closedness`, and `sheet` (`is_sheet`).
        mesh: the scene's section, with the origin of the source.
        name: of the mesh in tables; messages name its file.

    Raises:
        InputError: as `read_mesh` and `clean_mesh`, before anything is written.
    """
    mesh_in_sphere = normalised(*read_mesh(source), str(source))
    content = hashlib.sha256(mesh_bytes(source)).hexdigest()
    report = {
        "name": name,
        "source": source.name,
        "sha256": sha256_of(source),
        "thesis_mesh": is_thesis_mesh(mesh, content),
        "centre": mesh_in_sphere.centre.tolist(),
        "radius": mesh_in_sphere.radius,
        **mesh_in_sphere.report,
        "sheet": mesh_in_sphere.sheet,
    }
    if report["sheet"]:
        print(
            f"mesh {source}: an open sheet without an inside. Its occupancy fields are sheets; "
            "fields with a `surface` or `start` inside the object are unfit",
            file=progress.TERMINAL,
        )
    with whole_file(mesh_ply) as part:
        shape = trimesh.Trimesh(mesh_in_sphere.vertices, mesh_in_sphere.faces, process=False)
        part.write_bytes(shape.export(file_type="ply"))
        write_json(mesh_json, report | describe_origin())


if "snakemake" in globals():
    run_stage(snakemake, prepare_mesh)
