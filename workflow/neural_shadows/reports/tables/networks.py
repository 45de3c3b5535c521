"""Quality, bytes, building and speed of networks and baselines [5.4.1]."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, Literal

import numpy as np
import pandas as pd
from pydantic import Field

from neural_shadows.evaluation.metric_files import read_view_metrics
from neural_shadows.evaluation.null_predictors import NULL, is_null
from neural_shadows.evaluation.registry import RAY_TRACED
from neural_shadows.files.whole_files import read_json
from neural_shadows.layout.layout import Layout
from neural_shadows.layout.tables import before_training, experiments_of
from neural_shadows.metrics.registry import metrics as metrics_by_key
from neural_shadows.reports.data import phrases, quality, quality_cells, timing
from neural_shadows.reports.data.digits import short
from neural_shadows.reports.data.inputs import by_folder, read_biases, read_by_folder, read_seconds
from neural_shadows.reports.data.learned import margins
from neural_shadows.reports.data.published import TABLE_OF_SCENE, printed_networks, read_published
from neural_shadows.reports.data.table import (
    Column,
    Table,
    filled,
    number_cells,
    numbers,
)
from neural_shadows.sections.rows import TableByScene
from neural_shadows.sections.scenes import MeshName
from neural_shadows.sections.sections import Sections
from neural_shadows.settings.base import check_among
from neural_shadows.settings.records import Row, Run, SceneInfo

# Facts of a method beside its quality; empty where they do not apply.
FACTS = ("encoding", "parameters", "stored_bytes", "coded", "resident_bytes", "build_seconds")
FACTS += ("training_seconds", "samples", "depth_bias", "push", "bias_at_end", "unfit")
SPEEDS = ("rays_per_second", *timing.OWN_MS, *timing.FRAME_MS, "device")


class Settings(TableByScene):
    """Quality and costs of networks and baselines, by scene [5.4.1]."""

    own_chapter = "extensions"
    null_rows = tuple(NULL)
    timed = True
    kind: Literal["networks"] = Field(description="`networks`")
    against: dict[MeshName, str] = Field(
        {}, description="the row whose paired differences to all others are given, by scene"
    )

    def check(self, config: Sections, key: str) -> None:
        super().check(config, key)
        for scene in self.against:
            check_among(f"{key}.against", scene, self.named_rows(config))


def params(layout: Layout, table: str) -> dict[str, Any]:
    names = experiments_of(layout.entry("tables", table)["rows"])
    return {"durations": {name: before_training(layout, name) for name in names}}


def table(
    times: list[Path],
    metrics: list[Path],
    weights: list[Path],
    trainings: list[Path],
    depth_biases: list[Path],
    meshes: list[Path],
    lpips_json: Path,
    published_csv: Path,
    against: Mapping[str, str],
    durations: Mapping[str, Sequence[str]],
    rows: Sequence[Row],
    run: Run,
    scenes: Mapping[str, SceneInfo],
) -> Table:
    """Tabulate methods in the order of `rows`, scenes kept together.

    Below the methods of a scene that the thesis prints, on a mesh as it describes it, stand its
    own values; the null predictors come last.

    CSV: `scene`, `method`, the columns of `scene_quality`, `FACTS`, `SPEEDS`, and the context.

    Args:
        against: by scene, the reference method of paired differences.
        durations: of each experiment, the benchmarks of the jobs between its mesh's file and its
            training; files may be missing.
    """
    timed = {record["scene"]: record for record in map(read_json, times)}
    records = {record["name"]: record for record in map(read_json, trainings)}
    biases = read_biases(rows, depth_biases)
    reports, lpips = read_by_folder(meshes), read_json(lpips_json)
    printed = read_published(published_csv)

    context = {
        scene: quality.context_columns(mesh, lpips, run, scenes[scene]["seed"])
        for scene, mesh in reports.items()
    }
    facts = [facts_of(row, records, biases, timed, durations, context) for row in rows]
    table = pd.concat([timing.timing_table(timed, rows, weights), pd.DataFrame(facts)], axis=1)
    scored = quality.scenes_quality(metrics, rows, margins(printed), against, run["seed"])
    table = table.merge(scored, on=["scene", "method"], how="left")
    same = [
        name for name, mesh in reports.items() if mesh["thesis_mesh"] and name in TABLE_OF_SCENE
    ]
    table = with_printed(table, [is_null(row["method"]) for row in rows], same, printed)
    first = ["scene", "method", *scored.columns.drop(["scene", "method"]), *FACTS, *SPEEDS]
    rest = table.columns.difference([*first, "repeats"], sort=False)
    table = table.reindex(columns=[*first, *rest])  # maps alone have none of some facts

    labels = {(row["scene"], row["method"]): row["label"] for row in rows}
    others = [f"{labels[pair]} ({pair[0]})" for pair in against.items()]
    leaks = {
        s: quality.null_leaks(read_view_metrics(files)) for s, files in by_folder(metrics).items()
    }
    notes = [
        "Over a scene's views [95 % bootstrap interval]. stored: bytes of the weight file, 4 N² "
        "for a shadow map, 2 N² with 16 bits; 4 of each weight of the thesis's network, of which 2 would do, but for its "
        "last layer, where it is evaluated in bfloat16. coded: entropy-coded, a mesh by Draco, a field's "
        "differences by LZMA; all others are packed bits. resident: memory during evaluation. "
        "build: from the mesh file to the finished network, as the sum of the jobs for its mesh, rays, "
        "labels and training. own: median of the method's evaluation alone. "
        "frame: of whole frames, primary visibility and shading included.",
        *quality_cells.describe_quality(table, ", ".join(others)),
        *phrases.describe_devices(timing.devices(timed)),
        "bias: of the depth test, in sphere radii: each method's best on held-out views, unless it is "
        "0; of shadow maps in addition to the slope-scaled bias, where it was searched."
        + (f" †: {phrases.AT_END}." if table["bias_at_end"].eq(True).any() else ""),
        *phrases.describe_printed(same),
        *phrases.describe_budgets([*records.values()]),
        *(phrases.describe_shadows(scene, leak) for scene, leak in leaks.items()),
        *(phrases.describe_scene(name, mesh, scenes[name]) for name, mesh in reports.items()),
        *(phrases.describe_times(values) for values in timed.values()),
        *(phrases.describe_training(record) for record in records.values()),
        phrases.describe_frames(run),
        phrases.describe_lpips(lpips),
    ]
    return Table(table, cells(table), notes, text_columns=2)


def facts_of(
    row: Row,
    records: Mapping[str, Row],
    biases: Mapping[tuple[str, str], Row],
    timed: Mapping[str, Row],
    durations: Mapping[str, Sequence[str]],
    context: Mapping[str, Row],
) -> dict[str, Any]:
    """Facts of a row's method beside quality, bytes and times."""
    scene, method = row["scene"], row["method"]
    facts: dict[str, Any] = {} if method == RAY_TRACED else dict(context[scene])
    if bias := biases.get((scene, method)):
        facts |= {"depth_bias": bias["depth_bias"], "push": bias["push"]}
        facts["bias_at_end"] = bias["at_end"]
    if row["experiment"]:
        record = records[row["experiment"]]
        rates = timed[scene]["rays_per_second"].get(method)
        facts |= {
            "encoding": record["network"]["encoding"],
            "parameters": record["parameters"],
            "coded": record["network"].get("stored") == "coded",
            "unfit": record["unfit"],
            "build_seconds": read_seconds(map(Path, durations[row["experiment"]]))
            + record["seconds"],
            "training_seconds": record["seconds"] if record["training"] else np.nan,
            "samples": record["samples"],
            "rays_per_second": np.nan if rates is None else np.median(rates),
        }
    return facts


def with_printed(
    table: pd.DataFrame, null: Sequence[bool], scenes: Sequence[str], published: pd.Series
) -> pd.DataFrame:
    """Add the thesis's printed networks to `scenes`, and put `null` last."""
    parts = []
    for scene, part in table.assign(null=null).groupby("scene", sort=False):
        printed = printed_networks(published, scene) if scene in scenes else pd.DataFrame()
        last = part["null"]
        parts += [part[~last], printed.assign(scene=scene), part[last]]
    return pd.concat([part for part in parts if len(part)], ignore_index=True).drop(columns="null")


def cells(table: pd.DataFrame) -> dict[str, Column | Iterable[str]]:
    """Format the columns; the first row of a scene names it."""
    measured = table["lpips_low"].notna().any()  # printed values have no interval
    perceived = "lpips" if measured else "flip"
    # The thesis does not say whether its PSNR is pooled, and has no views to pool.
    means = number_cells(table["psnr"], "{:.2f} (pooled or mean)")
    pooled = quality_cells.quality_column(table, "psnr_pooled")
    pooled = replace(pooled, texts=[text or mean for text, mean in zip(pooled.texts, means)])
    ends = ["" if end is not True else " †" for end in table["bias_at_end"]]
    biases = number_cells(table["depth_bias"], "{:.4g}")
    columns = {
        "scene": table["scene"].where(~table["scene"].duplicated(), ""),
        "method": quality_cells.method_column(table),
        "pooled PSNR ↑": pooled,
        "difference, dB": quality_cells.difference_column(table),
        metrics_by_key()[perceived].heading: quality_cells.quality_column(table, perceived),
        "equal map": quality_cells.map_cells(table["map_lpips"], table["map_psnr"]),
        "stored KiB ↓": numbers(table["stored_bytes"], "{:,.0f}", 1 / 1024),
        "coded": ["yes" if coded is True else "" for coded in table["coded"]],
        "resident KiB ↓": numbers(table["resident_bytes"], "{:,.0f}", 1 / 1024),
        "build s ↓": numbers(table["build_seconds"], "{:,.0f}"),
        "own ms ↓": numbers(table["own_ms"], short),
        "frame ms ↓": numbers(table["frame_ms"], "{:.0f}"),
        "bias": [f"{bias}{end}" for bias, end in zip(biases, ends)],
    }
    if table["device"].nunique() > 1:
        columns["device"] = table["device"].fillna("")
    return filled(columns)
