"""Memory of networks and shadow maps [4.4.2, table 4.7]."""

import datetime
from collections.abc import Mapping, Sequence
from pathlib import Path

import pandas as pd

from neural_shadows.errors import InputError
from neural_shadows.evaluation.memory import network_bytes, shadow_map_bytes, shadow_map_file_bytes
from neural_shadows.meshes.prepared_mesh import read_prepared
from neural_shadows.reports.published import printed, read_published
from neural_shadows.reports.tables.writing import thesis_texts, write_twins
from neural_shadows.scenes.tracing import Tracer

MIB = 2**20


def write_memory_table(
    mesh_ply: Path,
    weights: Mapping[str, Path],
    published_csv: Path,
    csv_path: Path,
    md_path: Path,
    *,
    title: str,
    number: str | None,
    rows: Sequence[Mapping[str, str | None]],
    scale: str,
) -> None:
    """Write the bytes of each method, by formula, beside the thesis's numbers.

    The formula is checked: a network's against its weight file, a map's against the file of a
    map that is traced for it.

    Args:
        mesh_ply: of the scene that the maps are traced of.
        weights: weight files by the key of the method.

    Raises:
        InputError: a file's real size is not what the formula says.
    """
    mesh = read_prepared(mesh_ply)
    tracer = Tracer(mesh.vertices, mesh.faces)
    published = read_published(published_csv)
    records = []
    for row in rows:
        method = row["method"]
        if method in weights:
            size = network_bytes(weights[method])
        else:
            size = shadow_map_bytes(method)
            stored = shadow_map_file_bytes(mesh, tracer, method)
            if stored != size:
                raise InputError(
                    f"{method}: its file holds {stored:,} bytes, the formula says {size:,}"
                )
        value = printed(published, number, row["published"] or method, "memory_mib")
        records.append(
            {
                "method": row["label"],
                "memory_mib": size / MIB,
                "bytes": size,
                "thesis_memory_mib": value,
                "memory_mib_minus_thesis": size / MIB - value,
                "scale": scale,
            }
        )
    frame = pd.DataFrame(records).sort_values("bytes", ascending=False, kind="stable")
    columns = {
        "method": frame["method"].tolist(),
        "memory MiB": [f"{value:.4g}" for value in frame["memory_mib"]],
        "thesis MiB": [
            text.rstrip("0").rstrip(".") for text in thesis_texts(frame["thesis_memory_mib"], 4)
        ],
        "bytes": [f"{value:,}" for value in frame["bytes"]],
    }
    notes = [
        "By formula: 4 bytes for each weight of a network, 4 N² for a shadow map of N² texels. "
        "Checked: a network's against its weight file, a map's against the file of a traced map.",
        f"Scale: {scale}; made on {datetime.date.today().isoformat()}.",
    ]
    if number:
        title += f" (table {number} of the thesis)"
    write_twins(frame, columns, csv_path, md_path, title=title, notes=notes)
