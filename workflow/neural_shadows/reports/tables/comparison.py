"""Quality of methods on the same views, beside printed numbers [4.2, 4.3]."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, Literal

import pandas as pd
from pydantic import Field

from neural_shadows.evaluation.metric_files import read_view_metrics
from neural_shadows.evaluation.null_predictors import NULL, is_null
from neural_shadows.files.whole_files import read_json
from neural_shadows.layout.layout import Layout
from neural_shadows.metrics.registry import metric_in
from neural_shadows.metrics.registry import metrics as metrics_by_key
from neural_shadows.reports.data import phrases, quality, quality_cells
from neural_shadows.reports.data.equivalent_maps import equivalent_maps
from neural_shadows.reports.data.inputs import read_biases
from neural_shadows.reports.data.learned import THESIS_METRICS, margins
from neural_shadows.reports.data.published import add_printed, printed_table, read_published
from neural_shadows.reports.data.table import Column, Table
from neural_shadows.sections.any_report import Chapter
from neural_shadows.sections.rows import TableOfOneScene
from neural_shadows.settings.records import Row, Run, SceneInfo

PRINTED = THESIS_METRICS
SLOPE_BIAS = (
    "Shadow maps are square and have a bias by the slope, 0.5 + 0.75 tan θ texels and 20 at most."
)


class Settings(TableOfOneScene):
    """Methods on the same viewpoints of one scene: their quality."""

    null_rows = tuple(NULL)

    kind: Literal["comparison"] = Field("comparison", description="`comparison`, the default")
    against: str | None = Field(
        None, description="the row whose paired differences to all others are given"
    )
    more_metrics: list[metric_in("hard")] = Field(
        [], description="further metrics of `metrics/kinds`, as columns"
    )

    def chapter_of(self) -> Chapter:
        return self.chapter or ("thesis" if self.published else "extensions")


def files(layout: Layout, table: str) -> dict[str, Any]:
    # Not read: a table makes the preview of its scene, too.
    scene = layout.entry("tables", table)["rows"][0]["scene"]
    return {"beside": [layout.paths.report(f"scenes/{scene}.png")]}


def table(
    metrics: list[Path],
    mesh_json: Path,
    trainings: list[Path],
    depth_biases: list[Path],
    lpips_json: Path,
    published_csv: Path,
    title: str,
    published: str | None,
    against: str | None,
    rows: Sequence[Row],
    run: Run,
    scenes: Mapping[str, SceneInfo],
    more_metrics: Sequence[str] = (),
) -> Table:
    """Compare methods on a scene, sorted by LPIPS or else FLIP.

    The null predictors come last. CSV: the columns of `scene_quality`, `unfit`, those of `add_printed` and
    `add_printed_maps`, and the context.

    Args:
        against: the reference method of paired differences; None for no differences.
        more_metrics: of the CSV, as further columns.
    """
    name = rows[0]["scene"]
    scene, mesh, lpips = scenes[name], read_json(mesh_json), read_json(lpips_json)
    records, printed = [read_json(path) for path in trainings], read_published(published_csv)
    table = quality.scene_quality(metrics, rows, margins(printed), against, run["seed"])
    unfit = {record["name"]: record["unfit"] for record in records}
    table["unfit"] = pd.Series([unfit.get(row["experiment"]) for row in rows], dtype=object)
    table = add_printed(table, rows, PRINTED, published, published_csv, {name: mesh})
    table = add_printed_maps(table, rows, printed, published if mesh["thesis_mesh"] else None)
    table = table.assign(**quality.context_columns(mesh, lpips, run, scene["seed"]))
    order = "lpips" if table["lpips"].notna().any() else "flip"
    last = pd.Series([is_null(row["method"]) for row in rows])
    table = table.assign(last=last).sort_values(["last", order], kind="stable", ignore_index=True)
    table = table.drop(columns="last")

    labels = {row["method"]: row["label"] for row in rows}
    notes = [f"Mean over {table['views'].iloc[0]} views [95 % bootstrap interval]."]
    if published and mesh["thesis_mesh"]:
        unnamed = (
            "" if scene["procedural"] else ", of a resolution of its mesh that it does not name"
        )
        notes += [f"*thesis*: its printed number{unnamed}.", SLOPE_BIAS]
    elif published:
        notes.append(f"The thesis did not measure the mesh {mesh['name']}: none of its numbers.")
    notes += [
        *quality_cells.describe_quality(table, labels.get(against)),
        phrases.describe_shadows(name, quality.null_leaks(read_view_metrics(metrics))),
        *phrases.describe_biases(rows, read_biases(rows, depth_biases)),
        phrases.describe_scene(name, mesh, scene),
        *map(phrases.describe_training, records),
        phrases.describe_frames(run),
        phrases.describe_lpips(lpips),
    ]
    title = phrases.titled(title, published, mesh)
    return Table(table, cells(table, more_metrics), notes, title=title)


def add_printed_maps(
    frame: pd.DataFrame,
    rows: Sequence[Row],
    published: pd.Series,
    number: str | None,
) -> pd.DataFrame:
    """Add `equivalent_maps` of a printed table: `thesis_map_lpips`, `thesis_map_psnr`.

    Empty without a table (`number` is None) and for methods not in it.
    """
    texts: dict[str, pd.Series] = {}
    if number is not None:
        printed = printed_table(published, number)
        maps = equivalent_maps(printed, printed.index, "psnr")
        texts = {name: pd.Series(sizes, printed.index) for name, sizes in maps.items()}
    columns = {
        f"thesis_{name}": [texts.get(name, {}).get(row["published"], "") for row in rows]
        for name in ("map_lpips", "map_psnr")
    }
    return frame.assign(**columns)


def cells(
    table: pd.DataFrame, more_metrics: Sequence[str] = ()
) -> dict[str, Column | Iterable[str]]:
    """Format the thesis's columns, and measures of their reliability."""
    columns: dict[str, Column | Iterable[str]] = {"method": quality_cells.method_column(table)}
    measured = [metric for metric in PRINTED if table[metric].notna().any()]
    for metric in ["flip"] * ("lpips" not in measured) + measured:
        heading = metrics_by_key()[metric].heading
        columns[heading] = quality_cells.quality_column(table, metric)
        if metric in PRINTED and table[f"thesis_{metric}"].notna().any():
            printed = quality_cells.metric_column(table, metric, f"thesis_{metric}")
            columns[f"thesis {metrics_by_key()[metric].name}"] = replace(
                printed, printed_of=heading
            )
    columns["pooled PSNR ↑"] = quality_cells.metric_column(table, "psnr_pooled")
    if table["psnr_difference"].notna().any():
        columns["difference, dB"] = quality_cells.difference_column(table)
    for source in ("", "thesis "):
        names = [f"{source.replace(' ', '_')}map_{metric}" for metric in ("lpips", "psnr")]
        maps = quality_cells.map_cells(*(table[name] for name in names))
        if any(maps):
            columns[f"{source}equal map"] = Column(maps, printed_of="equal map" if source else "")
    columns["shadow error % ↓"] = quality_cells.metric_column(table, "shadow_error")
    for metric in more_metrics:
        columns[metrics_by_key()[metric].heading] = quality_cells.quality_column(table, metric)
    return columns
