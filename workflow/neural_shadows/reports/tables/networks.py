"""Networks beside shadow maps: quality, bytes, training and speed in one table [5.4.1]."""

import datetime
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from neural_shadows.evaluation.depth_biases import biases_by_method
from neural_shadows.evaluation.frame_times import read_frame_times
from neural_shadows.evaluation.memory import network_bytes, shadow_map_bytes
from neural_shadows.evaluation.method_names import RAY_TRACED, experiment_of
from neural_shadows.evaluation.per_view_metrics import read_metrics
from neural_shadows.meshes.mesh_report import read_mesh_report
from neural_shadows.metrics.lpips_choice import read_lpips_choice
from neural_shadows.reports.phrases import (
    REFERENCES,
    describe_mesh,
    describe_times,
    describe_training,
)
from neural_shadows.reports.published import COLUMNS
from neural_shadows.reports.tables.comparison import METRICS, comparison_table
from neural_shadows.reports.tables.writing import interval_text, write_twins
from neural_shadows.training.record import read_training

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


def method_facts(
    method: str,
    times: Mapping[str, Any],
    sizes: Mapping[str, int],
    records: Mapping[str, Mapping[str, Any]],
    depth_biases: Mapping[str, float],
) -> dict[str, Any]:
    """The `FACTS` of a method.

    Args:
        times: of the method's scene, as `read_frame_times` gives them.
        sizes: bytes of networks by method.
        records: what trainings wrote, by experiment.
        depth_biases: of networks by method.
    """
    first, median, third = np.quantile(times["methods"][method]["ms"], (0.25, 0.5, 0.75))
    facts = dict.fromkeys(FACTS, np.nan) | {
        "encoding": "",
        "frame_ms": median,
        "frame_ms_q1": first,
        "frame_ms_q3": third,
    }
    if method in sizes:
        record = records[experiment_of(method)]
        facts |= {
            "encoding": record["network"]["encoding"],
            "bytes": sizes[method],
            "parameters": record["parameters"],
            "training_seconds": record["seconds"],
            "samples": record["samples"],
            "depth_bias": depth_biases[method],
            "rays_per_second": float(np.median(times["rays_per_second"][method])),
        }
    elif method != RAY_TRACED:
        facts["bytes"] = shadow_map_bytes(method)
    return facts


def networks_table(
    rows: Sequence[Mapping[str, str | None]],
    scenes: Sequence[str],
    metrics: Mapping[str, pd.DataFrame],
    facts: Sequence[Mapping[str, Any]],
    contexts: Mapping[str, Mapping[str, Any]],
    seed: int,
) -> pd.DataFrame:
    """A row per method in the order of `rows`, scenes kept together.

    Args:
        rows: `method` and `label` of each row; `scenes`, `facts`: the scene and `FACTS` of each.
        metrics: as `read_metrics` gives it, by scene. A ray-traced row has none: it is the
            reference itself.
        contexts: see `comparison_table`, by scene.

    Returns:
        Columns `scene, method`, the metrics with their intervals, `views`, `FACTS` and the
        context.

    Raises:
        InputError: a method lacks values, or has some that are not finite.
    """
    frames = []
    nothing = pd.DataFrame(columns=COLUMNS)  # the thesis prints none of these numbers
    for scene in dict.fromkeys(scenes):
        here = [i for i, at in enumerate(scenes) if at == scene]
        measured = [dict(rows[i]) for i in here if rows[i]["method"] != RAY_TRACED]
        quality = comparison_table(metrics[scene], measured, None, nothing, contexts[scene], seed)
        quality = quality.loc[:, ~quality.columns.str.contains("thesis")]
        known = pd.DataFrame([{"method": rows[i]["label"], **facts[i]} for i in here])
        frames.append(known.merge(quality, on="method", how="left").assign(scene=scene))
    table = pd.concat(frames, ignore_index=True)
    quality = [name for metric in METRICS for name in (metric, f"{metric}_low", f"{metric}_high")]
    context = [name for name in table if name not in {"scene", "method", *quality, *FACTS}]
    return table[["scene", "method", *quality, *FACTS, *context]]


def write_networks_table(
    times_jsons: Sequence[Path],
    metrics: Mapping[str, Sequence[Path]],
    weights: Mapping[str, Path],
    training_jsons: Sequence[Path],
    bias_jsons: Sequence[Path],
    meshes: Mapping[str, Path],
    lpips_json: Path,
    csv_path: Path,
    md_path: Path,
    *,
    title: str,
    rows: Sequence[Mapping[str, str | None]],
    scenes: Sequence[str],
    procedural: Mapping[str, bool],
    scale: str,
    width: int,
    height: int,
    reference: str,
    seeds: Mapping[str, int],
    given_biases: Mapping[str, float],
    seed: int,
) -> None:
    """Write the table as CSV and Markdown.

    Args:
        metrics: files of per-view metrics by scene.
        weights: weight files by the key of the method; their size is measured.
        meshes: descriptions by scene; `procedural`: whether the pipeline made the mesh.
        scenes: the scene of each row.
        width, height: of the frames, in pixels.
        reference: `exact` or `shadow_map`.
        seeds: of the viewpoints, by scene; `seed`: of the bootstrap.
        given_biases: depth biases of methods that are in no file of `bias_jsons`.

    Raises:
        InputError: a file is missing or not whole.
    """
    times = read_frame_times(times_jsons)
    described = {scene: read_mesh_report(path) for scene, path in meshes.items()}
    lpips = read_lpips_choice(lpips_json)
    records = {record["name"]: record for record in map(read_training, training_jsons)}
    sizes = {method: network_bytes(path) for method, path in weights.items()}
    depth_biases = dict(given_biases) | biases_by_method(bias_jsons)
    frame = networks_table(
        rows,
        scenes,
        {scene: read_metrics(paths) for scene, paths in metrics.items()},
        [
            method_facts(row["method"], times[scene], sizes, records, depth_biases)
            for row, scene in zip(rows, scenes, strict=True)
        ],
        {
            scene: {
                "mesh": report["name"],
                "scale": scale,
                "width": width,
                "height": height,
                "lpips_net": lpips["net"] if lpips["available"] else None,
                "seed": seeds[scene],
            }
            for scene, report in described.items()
        },
        seed,
    )
    notes = [
        "Mean over a scene's views [95 % bootstrap interval]; size: what the weight file stores, "
        "which may be more once it is laid out for queries, and 4 N² bytes for a shadow map; "
        "training: preparation included; rays/s: of the network alone; frame: median of whole "
        "frames, primary visibility and shading included.",
        "bias: of the depth test, in sphere radii; each network's best on held-out views, save "
        "where `no bias` is said. Shadow maps keep their slope-scaled bias, which is not tuned.",
        f"Scale: {scale}; frames of {width} × {height} for quality; "
        f"made on {datetime.date.today().isoformat()}.",
        *(
            f"Mesh of {scene}: {describe_mesh(report, procedural[scene])}; seed {seeds[scene]}."
            for scene, report in described.items()
        ),
        f"Reference: {REFERENCES[reference]}; ray tracing in the table is that too.",
        *(describe_times(values) for values in times.values()),
        *(f"Network {describe_training(record)}." for record in records.values()),
    ]
    if lpips["available"]:
        notes.append(f"LPIPS's network is `{lpips['net']}`.")
    else:
        notes.append(f"LPIPS is missing: {lpips['reason']}.")
    write_twins(
        frame,
        reading_columns(frame),
        csv_path,
        md_path,
        title=title,
        notes=notes,
        text_columns=2,
    )


def reading_columns(frame: pd.DataFrame) -> dict[str, list[str]]:
    """The Markdown's cells by heading."""

    def quality(metric: str, factor: float, decimals: int) -> list[str]:
        triples = frame[[metric, f"{metric}_low", f"{metric}_high"]].to_numpy(float) * factor
        return [
            "" if np.isnan(triple[0]) else interval_text(*triple, decimals) for triple in triples
        ]

    def plain(column: str, factor: float, pattern: str) -> list[str]:
        values = frame[column].to_numpy(float) * factor
        return ["" if np.isnan(value) else pattern.format(value) for value in values]

    return {
        "scene": frame["scene"].tolist(),
        "method": frame["method"].tolist(),
        "LPIPS ↓": quality("lpips", 1, 4),
        "PSNR ↑": quality("psnr", 1, 2),
        "SSIM ↑": quality("ssim", 1, 4),
        "FLIP ↓": quality("flip", 1, 4),
        "false shadow % ↓": plain("false_shadow", 100, "{:.3f}"),
        "light leak % ↓": plain("light_leak", 100, "{:.3f}"),
        "size KiB ↓": plain("bytes", 1 / 1024, "{:,.0f}"),
        "training s ↓": plain("training_seconds", 1, "{:.0f}"),
        "samples M": plain("samples", 1e-6, "{:.3g}"),
        "bias": plain("depth_bias", 1, "{:.4g}"),
        "M rays/s ↑": plain("rays_per_second", 1e-6, "{:.3g}"),
        "frame ms ↓": plain("frame_ms", 1, "{:.0f}"),
    }
