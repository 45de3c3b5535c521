"""Networks beside shadow maps: quality, bytes, training and speed in one table [5.4.1]."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from neural_shadows.evaluation.memory import network_bytes, shadow_map_bytes
from neural_shadows.evaluation.method_names import RAY_TRACED
from neural_shadows.evaluation.per_view_metrics import read_metrics
from neural_shadows.files.whole_files import read_json
from neural_shadows.reports import phrases
from neural_shadows.reports.inputs import by_folder, read_biases, read_meshes
from neural_shadows.reports.tables.quality import (
    METRICS,
    READING,
    context_columns,
    quality_cells,
    quality_table,
)
from neural_shadows.reports.tables.writing import number_texts, write_twins
from neural_shadows.running.stage import run_stage

# What a method is, beside its quality; empty where it does not apply.
FACTS = (
    "encoding",
    "bytes",
    "parameters",
    "training_seconds",
    "samples",
    "depth_bias",
    "rays_per_second",
    "frame_ms",
    "frame_ms_q1",
    "frame_ms_q3",
)


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
    """Write the table as CSV and Markdown, in the order of `rows`, scenes kept together.

    CSV: `scene`, `method`, the metrics with their intervals, `FACTS`, `views` and the context. A
    ray-traced row has no quality: it is the reference itself.

    Args:
        times, meshes: what `measure_frame_times` and `prepare_mesh` wrote, a file for each scene.
        metrics: per view, of all rows that are not ray traced.
        weights, trainings: of the networks among the rows, each once.
        depth_biases: those that were found, a file for each experiment.
        rows: as `config.rows` gives them.
        run: `scale`, `seed` (of the bootstrap), `width`, `height` (pixels), `reference`.
        scenes: `procedural` and `seed` (of the viewpoints) of the rows' scenes.

    Raises:
        InputError: a file is missing, or a method lacks a value.
    """
    timed = {one["scene"]: one for one in map(read_json, times)}
    records = {record["name"]: record for record in map(read_json, trainings)}
    sizes = {name: network_bytes(path) for name, [path] in by_folder(weights).items()}
    biases = read_biases(rows, depth_biases)
    reports, lpips = read_meshes(meshes), read_json(lpips_json)
    parts = []
    for scene, paths in by_folder(metrics).items():
        here = [row for row in rows if row["scene"] == scene]
        known = pd.DataFrame(
            {"scene": scene, "method": row["label"]}
            | _facts(row, timed[scene], sizes, records, biases)
            for row in here
        )
        measured = [row for row in here if row["method"] != RAY_TRACED]
        quality = quality_table(read_metrics(paths), measured, run["seed"])
        context = context_columns(reports[scene], lpips, run, scenes[scene]["seed"])
        parts.append(known.merge(quality.assign(**context), on="method", how="left"))
    table = pd.concat(parts, ignore_index=True)
    quality = [name for metric in METRICS for name in (metric, f"{metric}_low", f"{metric}_high")]
    first = ["scene", "method", *quality, *FACTS]
    table = table[first + [name for name in table if name not in first]]

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
    write_twins(table, reading_columns(table), csv, md, title=title, notes=notes, text_columns=2)


def _facts(
    row: Mapping[str, Any],
    times: Mapping[str, Any],
    sizes: Mapping[str, int],
    records: Mapping[str, Mapping[str, Any]],
    depth_biases: Mapping[str, float],
) -> dict[str, Any]:
    """The `FACTS` of a row, from its scene's times; sizes and records are by experiment."""
    method, experiment = row["method"], row["experiment"]
    first, median, third = np.quantile(times["methods"][method]["ms"], (0.25, 0.5, 0.75))
    facts = dict.fromkeys(FACTS, np.nan) | {
        "encoding": "",
        "frame_ms": median,
        "frame_ms_q1": first,
        "frame_ms_q3": third,
    }
    if experiment:
        record = records[experiment]
        facts |= {
            "encoding": record["network"]["encoding"],
            "bytes": sizes[experiment],
            "parameters": record["parameters"],
            "training_seconds": record["seconds"],
            "samples": record["samples"],
            "depth_bias": depth_biases[method],
            "rays_per_second": float(np.median(times["rays_per_second"][method])),
        }
    elif method != RAY_TRACED:
        facts["bytes"] = shadow_map_bytes(method)
    return facts


def reading_columns(table: pd.DataFrame) -> dict[str, list[str]]:
    """The Markdown's cells by heading."""
    return {
        "scene": table["scene"].tolist(),
        "method": table["method"].tolist(),
        **{
            READING[name][0]: quality_cells(table, name)
            for name in ("lpips", "psnr", "ssim", "flip")
        },
        "false shadow % ↓": number_texts(table["false_shadow"], "{:.3f}", 100),
        "light leak % ↓": number_texts(table["light_leak"], "{:.3f}", 100),
        "size KiB ↓": number_texts(table["bytes"], "{:,.0f}", 1 / 1024),
        "training s ↓": number_texts(table["training_seconds"], "{:.0f}"),
        "samples M": number_texts(table["samples"], "{:.3g}", 1e-6),
        "bias": number_texts(table["depth_bias"], "{:.4g}"),
        "M rays/s ↑": number_texts(table["rays_per_second"], "{:.3g}", 1e-6),
        "frame ms ↓": number_texts(table["frame_ms"], "{:.0f}"),
    }


if "snakemake" in globals():
    run_stage(snakemake, write)
