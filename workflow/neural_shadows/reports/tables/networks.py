"""Networks beside shadow maps: quality, bytes, training and speed in one table [5.4.1]."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from neural_shadows.evaluation.method_names import RAY_TRACED
from neural_shadows.files.whole_files import read_json
from neural_shadows.reports import phrases
from neural_shadows.reports.inputs import read_biases, read_meshes
from neural_shadows.reports.tables import quality
from neural_shadows.reports.tables.writing import number_cells, write_twins
from neural_shadows.running.stage import run_stage

# What a method is, beside its quality; empty where it does not apply.
FACTS = ("encoding", "bytes", "parameters", "training_seconds", "samples", "depth_bias")
SPEEDS = ("rays_per_second", "frame_ms", "frame_ms_q1", "frame_ms_q3")


def write(
    *,
    times: list[Path],
    metrics: list[Path],
    weights: list[Path],
    trainings: list[Path],
    depth_biases: list[Path],
    meshes: list[Path],
    lpips_json: Path,
    csv: Path,
    md: Path,
    title: str,
    rows: Sequence[Mapping[str, Any]],
    run: Mapping[str, Any],
    scenes: Mapping[str, Mapping[str, Any]],
) -> None:
    """Write the table in the order of `rows`, scenes kept together.

    CSV: `scene`, `method`, the metrics with their intervals, `FACTS`, `SPEEDS`, `views` and
    the context.
    """
    timed = {one["scene"]: one for one in map(read_json, times)}
    records = {record["name"]: record for record in map(read_json, trainings)}
    biases = read_biases(rows, depth_biases)
    reports, lpips = read_meshes(meshes), read_json(lpips_json)
    facts = []
    for row in rows:
        scene, method = row["scene"], row["method"]
        facts.append({"scene": scene, "method": row["label"]})
        if method != RAY_TRACED:
            facts[-1] |= quality.context_columns(reports[scene], lpips, run, scenes[scene]["seed"])
        if row["experiment"]:
            record = records[row["experiment"]]
            facts[-1] |= {
                "encoding": record["network"]["encoding"],
                "parameters": record["parameters"],
                "training_seconds": record["seconds"],
                "samples": record["samples"],
                "depth_bias": biases[method],
                "rays_per_second": np.median(timed[scene]["rays_per_second"][method]),
            }
    table = quality.timed_quality(timed, metrics, weights, rows, run["seed"])
    table = table.merge(pd.DataFrame(facts), on=["scene", "method"])
    scores = [name for metric in quality.METRICS for name in quality.with_ends(metric)]
    first = ["scene", "method", *scores, *FACTS, *SPEEDS, "views"]
    table = table[[*first, *table.columns.difference([*first, "repeats"], sort=False)]]

    columns = {
        "scene": table["scene"],
        "method": table["method"],
        **{quality.READING[m][0]: quality.quality_cells(table, m) for m in quality.METRICS[:4]},
        "false shadow % ↓": number_cells(table["false_shadow"], "{:.3f}", 100),
        "light leak % ↓": number_cells(table["light_leak"], "{:.3f}", 100),
        "size KiB ↓": number_cells(table["bytes"], "{:,.0f}", 1 / 1024),
        "training s ↓": number_cells(table["training_seconds"], "{:.0f}"),
        "samples M": number_cells(table["samples"], "{:.3g}", 1e-6),
        "bias": number_cells(table["depth_bias"], "{:.4g}"),
        "M rays/s ↑": number_cells(table["rays_per_second"], "{:.3g}", 1e-6),
        "frame ms ↓": number_cells(table["frame_ms"], "{:.0f}"),
    }
    notes = [
        "Mean over a scene's views [95 % bootstrap interval]; size: what the weight file stores, "
        "which may be more once it is laid out for queries, and 4 N² bytes for a shadow map; "
        "training: preparation included; rays/s: of the network alone; frame: median of whole "
        "frames, primary visibility and shading included.",
        "bias: of the depth test, in sphere radii; each network's best on held-out views, unless it "
        "is 0. Shadow maps keep their slope-scaled bias, which is not tuned.",
        *(phrases.describe_scene(name, mesh, scenes[name]) for name, mesh in reports.items()),
        *(phrases.describe_times(values) for values in timed.values()),
        *(phrases.describe_training(record) for record in records.values()),
        phrases.describe_frames(run),
        phrases.describe_lpips(lpips),
        phrases.describe_run(run),
    ]
    write_twins(table, columns, csv, md, title=title, notes=notes, text_columns=2)


if "snakemake" in globals():
    run_stage(snakemake, write)
