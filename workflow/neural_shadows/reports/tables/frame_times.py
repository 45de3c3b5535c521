"""Frame time, quality and size of networks over their width [4.4.1, table 4.6]."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from neural_shadows.files.whole_files import read_json
from neural_shadows.reports import phrases
from neural_shadows.reports.inputs import read_meshes
from neural_shadows.reports.published import add_printed
from neural_shadows.reports.tables.quality import quality_cells, timed_quality, with_ends
from neural_shadows.reports.tables.writing import interval_cells, number_cells, write_twins
from neural_shadows.running.stage import run_stage

PRINTED = ("frame_ms", "lpips", "size_kib")  # what the thesis prints, in its order
FRAME_MS = ["frame_ms", "frame_ms_q1", "frame_ms_q3"]


def write(
    *,
    times: list[Path],
    metrics: list[Path],
    weights: list[Path],
    meshes: list[Path],
    lpips_json: Path,
    published_csv: Path,
    csv: Path,
    md: Path,
    title: str,
    published: str | None,
    rows: Sequence[Mapping[str, Any]],
    run: Mapping[str, Any],
) -> None:
    """Write a table of frame times, in the order of `rows`.

    CSV: `method, scene, frame_ms, frame_ms_q1, frame_ms_q3, repeats, lpips, lpips_low, lpips_high,
    size_kib`, then the columns of `add_printed` of the three that the thesis prints.
    """
    timed = {one["scene"]: one for one in map(read_json, times)}
    table = timed_quality(timed, metrics, weights, rows, run["seed"])
    table["size_kib"] = table["bytes"] / 1024
    table = table[["method", "scene", *FRAME_MS, "repeats", *with_ends("lpips"), "size_kib"]]
    described = read_meshes(meshes)
    table = add_printed(table, rows, PRINTED, published, published_csv, described)
    table = table.assign(scale=run["scale"])

    columns = {
        "scene": table["scene"],
        "method": table["method"],
        "frame ms ↓": interval_cells(table, FRAME_MS, 1),
        "thesis ms": number_cells(table["thesis_frame_ms"], "{:.1f}"),
        "LPIPS ↓": quality_cells(table, "lpips"),
        "thesis LPIPS": number_cells(table["thesis_lpips"], "{:.4f}"),
        "size KiB": number_cells(table["size_kib"], "{:.0f}"),
        "thesis KiB": number_cells(table["thesis_size_kib"], "{:.0f}"),
    }
    notes = [
        "Frame time: median [quartiles] of whole frames, primary visibility and shading "
        "included; LPIPS: mean over views [95 % bootstrap interval].",
    ]
    if published:
        notes.append("*thesis*: the number that it prints, its times from another machine.")
        notes += [
            f"*thesis*: sizes only for {scene}; it did not measure the mesh {mesh['name']}."
            for scene, mesh in described.items()
            if not mesh["thesis_mesh"]
        ]
    else:
        columns = {name: cells for name, cells in columns.items() if not name.startswith("thesis")}
    notes += [
        *(phrases.describe_times(values) for values in timed.values()),
        "A shadow map is rendered whole in each frame and its size is 4 N² bytes; ray tracing "
        "sends a shadow ray from each pixel that faces the light.",
        phrases.describe_lpips(read_json(lpips_json)),
        phrases.describe_run(run),
    ]
    write_twins(
        table, columns, csv, md, title=phrases.titled(title, published), notes=notes, text_columns=2
    )


if "snakemake" in globals():
    run_stage(snakemake, write)
