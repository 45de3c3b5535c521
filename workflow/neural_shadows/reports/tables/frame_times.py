"""Frame time, quality and size of networks over their width [4.4.1, table 4.6]."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from neural_shadows.evaluation.memory import network_bytes, shadow_map_bytes
from neural_shadows.evaluation.method_names import RAY_TRACED
from neural_shadows.evaluation.per_view_metrics import read_metrics
from neural_shadows.files.whole_files import read_json
from neural_shadows.metrics.intervals import mean_interval
from neural_shadows.reports import phrases
from neural_shadows.reports.inputs import by_folder, read_meshes
from neural_shadows.reports.published import add_printed, read_published
from neural_shadows.reports.tables.writing import interval_text, number_texts, write_twins
from neural_shadows.running.stage import run_stage

PRINTED = ("frame_ms", "lpips", "size_kib")  # what the thesis prints, in its order


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
    """Write a table of frame times as CSV and Markdown, in the order of `rows`.

    CSV: `method, scene, frame_ms, frame_ms_q1, frame_ms_q3, repeats, lpips, lpips_low, lpips_high,
    size_kib`, then `thesis_<column>` and `<column>_minus_thesis` of the three that the thesis
    prints. Its times and LPIPS stand beside methods on its own meshes alone; its sizes beside any.

    Args:
        times, meshes: what `measure_frame_times` and `prepare_mesh` wrote, a file for each scene.
        metrics: per view, of the rows that have an LPIPS.
        weights: of the networks among the rows; their size is measured.
        published: the thesis's number of the table, "4.6"; None for one that is not in it.
        rows: as `config.rows` gives them.
        run: `scale`, `seed` (of the bootstrap).
    """
    timed = {one["scene"]: one for one in map(read_json, times)}
    measured = {scene: read_metrics(paths) for scene, paths in by_folder(metrics).items()}
    sizes = {name: network_bytes(path) for name, [path] in by_folder(weights).items()}
    reports = read_meshes(meshes)
    table = pd.DataFrame(
        {
            "method": row["label"],
            "scene": row["scene"],
            **_times(timed[row["scene"]]["methods"][row["method"]]["ms"]),
            **_lpips(measured[row["scene"]], row["method"], run["seed"]),
            "size_kib": _bytes(row, sizes) / 1024,
        }
        for row in rows
    )
    table = add_printed(table, rows, PRINTED, published, read_published(published_csv))
    others = [scene for scene, mesh in reports.items() if not mesh["thesis_mesh"]]
    for column in ("frame_ms", "lpips"):
        names = [f"thesis_{column}", f"{column}_minus_thesis"]
        table.loc[table["scene"].isin(others), names] = np.nan
    table = table.assign(scale=run["scale"])

    notes = [
        "Frame time: median [quartiles] of whole frames, primary visibility and shading "
        "included; LPIPS: mean over views [95 % bootstrap interval].",
        *(phrases.describe_times(values) for values in timed.values()),
        "A shadow map is rendered whole in each frame and its size is 4 N² bytes; ray tracing "
        "sends a shadow ray from each pixel that faces the light.",
        phrases.describe_lpips(read_json(lpips_json)),
        phrases.describe_run(run),
    ]
    if published:
        notes[1:1] = [
            "*thesis*: the number that it prints, its times from another machine.",
            *(
                f"*thesis* has sizes alone for {scene}: it did not measure the mesh "
                f"{reports[scene]['name']}."
                for scene in others
            ),
        ]
    columns = reading_columns(table, published is not None)
    title = phrases.titled(title, published)
    write_twins(table, columns, csv, md, title=title, notes=notes, text_columns=2)


def _times(milliseconds: Sequence[float]) -> dict[str, float]:
    first, median, third = np.quantile(milliseconds, (0.25, 0.5, 0.75))
    repeats = len(milliseconds)
    return {"frame_ms": median, "frame_ms_q1": first, "frame_ms_q3": third, "repeats": repeats}


def _lpips(metrics: pd.DataFrame, method: str, seed: int) -> dict[str, float]:
    """NaN for a method, such as the reference itself, that is in no metrics."""
    values = metrics.query("method == @method and metric == 'lpips'")
    values = values.sort_values(["view_set", "view"])["value"].to_numpy()
    interval = mean_interval(values, seed) if len(values) else (np.nan,) * 3
    return dict(zip(("lpips", "lpips_low", "lpips_high"), interval))


def _bytes(row: Mapping[str, Any], networks: Mapping[str, int]) -> float:
    if row["experiment"]:
        return networks[row["experiment"]]
    return np.nan if row["method"] == RAY_TRACED else shadow_map_bytes(row["method"])


def reading_columns(table: pd.DataFrame, with_thesis: bool) -> dict[str, list[str]]:
    """The Markdown's cells by heading."""
    columns = {
        "scene": table["scene"].tolist(),
        "method": table["method"].tolist(),
        "frame ms ↓": [
            interval_text(*values, 1)
            for values in table[["frame_ms", "frame_ms_q1", "frame_ms_q3"]].to_numpy()
        ],
        "thesis ms": number_texts(table["thesis_frame_ms"], "{:.1f}"),
        "LPIPS ↓": [
            interval_text(*values, 4)
            for values in table[["lpips", "lpips_low", "lpips_high"]].to_numpy()
        ],
        "thesis LPIPS": number_texts(table["thesis_lpips"], "{:.4f}"),
        "size KiB": number_texts(table["size_kib"], "{:.0f}"),
        "thesis KiB": number_texts(table["thesis_size_kib"], "{:.0f}"),
    }
    return {
        heading: cells
        for heading, cells in columns.items()
        if with_thesis or not heading.startswith("thesis")
    }


if "snakemake" in globals():
    run_stage(snakemake, write)
