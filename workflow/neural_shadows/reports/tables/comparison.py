"""Methods on the same views, beside the numbers that the thesis prints [4.2, 4.3]."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from neural_shadows.evaluation.per_view_metrics import read_metrics
from neural_shadows.files.whole_files import read_json
from neural_shadows.reports import phrases
from neural_shadows.reports.inputs import read_biases
from neural_shadows.reports.published import add_printed
from neural_shadows.reports.tables import quality
from neural_shadows.reports.tables.writing import number_cells, write_twins
from neural_shadows.running.stage import run_stage

PRINTED = ("lpips", "psnr", "ssim")  # what the thesis's tables give, in its order


def write(
    *,
    metrics: list[Path],
    mesh_json: Path,
    trainings: list[Path],
    depth_biases: list[Path],
    lpips_json: Path,
    published_csv: Path,
    csv: Path,
    md: Path,
    title: str,
    published: str | None,
    rows: Sequence[Mapping[str, Any]],
    run: Mapping[str, Any],
    scenes: Mapping[str, Mapping[str, Any]],
) -> None:
    """Write a comparison on one scene, sorted by LPIPS as in the thesis, without it by FLIP.

    CSV: the columns of `quality_table`, those of `add_printed`, and the context.
    """
    name = rows[0]["scene"]
    scene, mesh, lpips = scenes[name], read_json(mesh_json), read_json(lpips_json)
    table = quality.quality_table(read_metrics(metrics), rows, scene["seed"])
    table = add_printed(table, rows, PRINTED, published, published_csv, {name: mesh})
    table = table.assign(**quality.context_columns(mesh, lpips, run, scene["seed"]))
    order = "lpips" if table["lpips"].notna().any() else "flip"
    table = table.sort_values(order, kind="stable", ignore_index=True)

    columns = {"method": table["method"]}
    for metric, (heading, _, decimals) in quality.READING.items():
        if table[metric].isna().all():  # LPIPS without its trunk
            continue
        columns[heading] = quality.quality_cells(table, metric)
        if published and metric in PRINTED:
            cells = number_cells(table[f"thesis_{metric}"], f"{{:.{decimals}f}}")
            columns[f"thesis {metric.upper()}"] = cells

    notes = [f"Mean over {table['views'].iloc[0]} views [95 % bootstrap interval]."]
    if published and mesh["thesis_mesh"]:
        notes.append("*thesis*: the number that it prints.")
    elif published:
        notes.append(f"*thesis*: empty, since it did not measure the mesh {mesh['name']}.")
    notes += [
        *phrases.describe_biases(rows, read_biases(rows, depth_biases)),
        phrases.describe_scene(name, mesh, scene),
        *(phrases.describe_training(read_json(path)) for path in trainings),
        phrases.describe_frames(run),
        phrases.describe_lpips(lpips),
        phrases.describe_run(run),
    ]
    write_twins(table, columns, csv, md, title=phrases.titled(title, published, mesh), notes=notes)


if "snakemake" in globals():
    run_stage(snakemake, write)
