"""Memory of networks and shadow maps [4.4.2, table 4.7]."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from neural_shadows.errors import InputError
from neural_shadows.evaluation.memory import network_bytes, shadow_map_bytes, shadow_map_file_bytes
from neural_shadows.meshes.prepared_mesh import read_prepared
from neural_shadows.reports import phrases
from neural_shadows.reports.inputs import by_folder
from neural_shadows.reports.published import add_printed, read_published
from neural_shadows.reports.tables.writing import number_cells, write_twins
from neural_shadows.running.stage import run_stage
from neural_shadows.scenes.tracing import Tracer

MIB = 2**20


def write(
    *,
    mesh_ply: Path,
    weights: list[Path],
    published_csv: Path,
    csv: Path,
    md: Path,
    title: str,
    published: str | None,
    rows: Sequence[Mapping[str, Any]],
    run: Mapping[str, Any],
) -> None:
    """Write the bytes of each method, by formula, beside the thesis's numbers.

    The formula is checked: a network's against its weight file, a map's against the file of a
    map that is traced for it. It knows no mesh, so that the thesis's numbers stand beside any.

    Args:
        mesh_ply: of the scene that the maps are traced of.
        weights: of the networks among the rows.
        published: the thesis's number of the table, "4.7"; None for one that is not in it.
        rows: `method`, `label`, `experiment` and `published` of each; run: `scale`.

    Raises:
        InputError: a file's real size is not what the formula says.
    """
    mesh = read_prepared(mesh_ply)
    tracer = Tracer(mesh.vertices, mesh.faces)
    sizes = {name: network_bytes(path) for name, [path] in by_folder(weights).items()}
    for row in rows:
        if not row["experiment"]:
            size = sizes[row["method"]] = shadow_map_bytes(row["method"])
            stored = shadow_map_file_bytes(mesh, tracer, row["method"])
            if stored != size:
                raise InputError(
                    f"{row['method']}: its file holds {stored:,} bytes, the formula says {size:,}"
                )
    table = pd.DataFrame(
        {"method": row["label"], "bytes": sizes[row["experiment"] or row["method"]]} for row in rows
    )
    table.insert(1, "memory_mib", table["bytes"] / MIB)
    table = add_printed(table, rows, ["memory_mib"], published, read_published(published_csv))
    table = table.assign(scale=run["scale"])
    table = table.sort_values("bytes", ascending=False, kind="stable")
    columns = {
        "method": table["method"],
        "memory MiB": number_cells(table["memory_mib"], "{:.4g}"),
        "thesis MiB": number_cells(table["thesis_memory_mib"], "{:.4g}"),
        "bytes": number_cells(table["bytes"], "{:,}"),
    }
    notes = [
        "By formula: 4 bytes for each weight of a network, 4 N² for a shadow map of N² texels. "
        "Checked: a network's against its weight file, a map's against the file of a traced map.",
        phrases.describe_run(run),
    ]
    write_twins(table, columns, csv, md, title=phrases.titled(title, published), notes=notes)


if "snakemake" in globals():
    run_stage(snakemake, write)
