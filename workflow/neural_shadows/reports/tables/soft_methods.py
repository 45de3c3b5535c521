"""Methods for soft shadows on the same frames: errors, flicker, time and bytes, by radius."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Literal

import numpy as np
import pandas as pd
from pydantic import Field

from neural_shadows.evaluation.null_predictors import NULL
from neural_shadows.evaluation.soft_metrics import read_soft_metrics
from neural_shadows.evaluation.soft_registry import tuned_as
from neural_shadows.files.whole_files import read_json
from neural_shadows.layout import soft_methods
from neural_shadows.layout.layout import Layout
from neural_shadows.metrics.pooled_psnr import psnr_of
from neural_shadows.reports.data import phrases
from neural_shadows.reports.data.frame_means import (
    ABOUT_EDGES,
    OFF_EDGES,
    describe_units,
    mean_over_scenes,
    mean_with_interval,
)
from neural_shadows.reports.data.lights import UNITS, light_name
from neural_shadows.reports.data.soft_costs import cost, describe_bytes, describe_times
from neural_shadows.reports.data.table import Table, filled, intervals, numbers, write_table
from neural_shadows.reports.data.width_notes import describe_widths
from neural_shadows.running.stage import run_stage
from neural_shadows.sections.frame_tables import MethodsTable
from neural_shadows.sections.sections import Sections
from neural_shadows.settings.base import Name
from neural_shadows.settings.records import Run, SoftTimes

WITH_INTERVALS = ("mse", OFF_EDGES, "l1")
ERRORS = ("mse", OFF_EDGES)
MEANS = (
    *("mse_umbra", "mse_penumbra", "mse_lit", "mse_edge", "false_shadow", "light_leak"),
    *("ssim", "flip", "lpips"),
)
FLICKER = (
    *("instability", "instability_reference", "instability_taa"),
    *("temporal_error", "temporal_error_reference", "temporal_error_taa"),
    *("mse_sequence", "mse_taa"),
)


class Settings(MethodsTable):
    """Methods for soft shadows on a frame set, by light: errors, flicker, time, bytes."""

    kind: Literal["soft_methods"] = Field(description="`soft_methods`")
    methods: list[Name] = Field(
        min_length=1,
        description="keys of `METHODS` in evaluation/soft_methods/, or networks, in the table's "
        "order; `no_shadow` and `all_dark` are there without being named",
    )

    def methods_shown(self) -> list[str]:
        return self.methods

    def resolved(self, config: Sections) -> dict[str, Any]:
        missing = [null for null in NULL if null not in self.methods]
        return self.model_dump() | {"methods": [*self.methods, *missing]}


def files(layout: Layout, table: str) -> dict[str, Any]:
    frame_set = soft_methods.frame_set(layout, table)
    return {
        "frames_json": soft_methods.tests(layout, frame_set)[0],
        "soft_metrics": soft_methods.evaluations(layout, table, "csv"),
        "soft_times": soft_methods.times(layout, table),
        "soft_constants": soft_methods.constants(layout, table),
        "widths_json": soft_methods.widths(layout, frame_set),
        "lpips_json": layout.paths.lpips,
    }


def params(layout: Layout, table: str) -> dict[str, Any]:
    frames = layout.entry("frame_sets", soft_methods.frame_set(layout, table))
    return {
        "labels": soft_methods.labels(layout, table),
        "left_out": soft_methods.left_out(layout, table),
        "unseen": frames.get("unseen", []),
        "run": layout.run(),
    }


def table(
    *,
    frames_json: Path,
    soft_metrics: list[Path],
    soft_times: Path | None,
    soft_constants: list[Path],
    widths_json: Path | None,
    lpips_json: Path,
    title: str,
    labels: Mapping[str, str],
    left_out: Sequence[str],
    unseen: Sequence[str],
    run: Run,
) -> Table:
    """A row for each radius and method, in the order of `labels`.

    CSV: all columns of `soft_table`, and the scale.

    Args:
        frames_json: a part of the frame set's test frames.
        soft_metrics: of each method; soft_times: what `time_soft_methods` wrote, None for frames
            without a scene to ask; soft_constants: what `tune_soft_method` wrote.
        widths_json: what `measure_widths` wrote; None for frames without targets.
        labels: what each method is called; left_out: methods that this machine does not have.
        unseen: scenes that no network trains on.
    """
    about, lpips = read_json(frames_json), read_json(lpips_json)
    times = read_json(soft_times) if soft_times else {"methods": {}}
    found = read_soft_metrics(soft_metrics)
    unit = UNITS[about.get("radius_unit", "metres")]
    radii = about.get("given_radii", about["radii"])
    table = soft_table(found, radii, times, labels, unseen)
    table = table.assign(unit=unit, scale=run["scale"])
    columns = {
        "light": [light_name(radius, unit) for radius in table["radius"]],
        "method": table["label"],
        "MSE × 10⁻⁴ ↓": intervals(table, ["mse", "mse_low", "mse_high"], 1, 1e4),
        "off edges": intervals(table, [OFF_EDGES, f"{OFF_EDGES}_low", f"{OFF_EDGES}_high"], 1, 1e4),
        "unseen scenes": numbers(table["mse_unseen"], "{:.1f}", 1e4),
        "unseen, off edges": numbers(table["off_edges_unseen"], "{:.1f}", 1e4),
        "umbra": numbers(table["mse_umbra"], "{:.1f}", 1e4),
        "penumbra": numbers(table["mse_penumbra"], "{:.1f}", 1e4),
        "lit": numbers(table["mse_lit"], "{:.1f}", 1e4),
        "edge": numbers(table["mse_edge"], "{:.1f}", 1e4),
        "PSNR dB ↑": numbers(table["psnr_pooled"], "{:.1f}"),
        "SSIM ↑": numbers(table["ssim"], "{:.3f}"),
        "FLIP ↓": numbers(table["flip"], "{:.4f}"),
        "LPIPS ↓": numbers(table["lpips"], "{:.4f}"),
        "false shadow %": numbers(table["false_shadow"], "{:.2f}", 100),
        "light leak %": numbers(table["light_leak"], "{:.2f}", 100),
        "flicker E": numbers(table["instability"], "{:.3f}"),
        "ms": numbers(table["ms"], "{:.1f}"),
        "KiB": numbers(table["bytes"] / 1024, "{:,.0f}"),
    }
    columns = filled(columns)
    records = {one["method"]: one for one in map(read_json, soft_constants)}
    chosen = {name: records[tuned_as(name)] for name in labels if tuned_as(name) in records}
    scenes, frames = [*found["scene"].unique()], table["frames"].iloc[0]
    parts = (
        f"Mean over {frames} frames of {about['width']} × {about['height']} in {len(scenes)} scenes "
        f"[{describe_units(scenes, frames)}]; "
    )
    notes = [
        f"{parts}unseen scenes: {', '.join(unseen) or 'none'}. The exact soft shadow is by rays from "
        "eight places a pixel.",
        *describe_widths(widths_json, scenes),
        "Squared errors: umbra, penumbra and lit by the exact shadow (below 2 %, between, above 98 "
        "%), edge within 3 pixels of the edges of a point light's. A pixel counts if it shows a "
        "surface inside the light's map. What faces away from the light's centre is dark for all "
        "methods but rays. FLIP and LPIPS are of the first frame of each part by the middle light.",
        *([ABOUT_EDGES] if table[OFF_EDGES].notna().any() else []),
        *_describe_orders(table, radii, unit),
        *_describe_constants(chosen, labels),
        *describe_times(times),
        *describe_bytes(times),
        *_describe_flicker(table, found, radii, unit),
        *([f"Not to be had on this machine: {', '.join(left_out)}."] if left_out else []),
        phrases.describe_lpips(lpips),
        phrases.describe_run(run),
    ]
    return Table(title, table, columns, notes)


def soft_table(
    found: pd.DataFrame,
    radii: Sequence[float],
    times: SoftTimes,
    labels: Mapping[str, str],
    unseen: Sequence[str],
) -> pd.DataFrame:
    """A row for each radius and method.

    Columns: `method, label, number` (of the radius, from 0), `radius, frames`, of `mse`, `mse_off_edges`
    and `l1` also the ends of their intervals, the other means, `psnr_pooled`, `mse_unseen`,
    `off_edges_unseen`, `own_ms`, `map_ms`, `ms`, `bytes`, those of `_flicker`.
    """
    frames = found[~found["metric"].isin(FLICKER)]
    rows = []
    for number, radius in enumerate(radii):
        lit = frames[frames["radius"] == number]
        for method, label in labels.items():
            here = lit[lit["method"] == method].set_index("scene")
            row = {"method": method, "label": label, "number": number, "radius": radius}
            row["frames"] = int((here["metric"] == "mse").sum())
            for name in WITH_INTERVALS:
                row |= mean_with_interval(here[here["metric"] == name]["value"], name)
            # Of a part that no frame has, there is no mean.
            row |= {n: mean_over_scenes(here[here["metric"] == n]["value"]) for n in MEANS}
            row["psnr_pooled"] = float(psnr_of(max(row["mse"], 1e-10)))
            some = here[here.index.isin(unseen)]
            row["mse_unseen"] = mean_over_scenes(some[some["metric"] == "mse"]["value"])
            row["off_edges_unseen"] = mean_over_scenes(some[some["metric"] == OFF_EDGES]["value"])
            rows.append(row | cost(times, method, number))
    table = pd.DataFrame(rows)
    return table.merge(_flicker(found), on=["method", "number"], how="left")


def _flicker(found: pd.DataFrame) -> pd.DataFrame:
    """By method and radius the means over sequences, and of each kind: `instability_camera`, …"""
    flicker = found[found["metric"].isin(FLICKER)].rename(columns={"radius": "number"})
    what = flicker["part"].str.rsplit("_", n=1).str[0]
    index = ["method", "number"]
    means = flicker.pivot_table("value", index, "metric").reindex(columns=FLICKER)
    each = flicker.assign(column=flicker["metric"] + "_" + what)
    return means.join(each.pivot_table("value", index, "column")).reset_index()


def _describe_orders(table: pd.DataFrame, radii: Sequence[float], unit: str) -> list[str]:
    """How often the two errors order two methods differently, by light; none where one is missing."""
    parts = []
    for number, rows in table.dropna(subset=["mse", OFF_EDGES]).groupby("number"):
        ahead = [np.less.outer(rows[name].to_numpy(), rows[name].to_numpy()) for name in ERRORS]
        pairs = len(rows) * (len(rows) - 1) // 2
        other = np.count_nonzero(ahead[0] & ahead[1].T)
        parts.append(f"{light_name(radii[number], unit)} {other} of {pairs}")
    if not parts:
        return []
    return [
        "Pairs of methods that the errors of all pixels and off edges order differently: "
        f"{'; '.join(parts)}."
    ]


def _describe_flicker(
    table: pd.DataFrame, found: pd.DataFrame, radii: Sequence[float], unit: str
) -> list[str]:
    shown = table.dropna(subset="instability")
    if shown.empty:
        return []
    parts = found[found["metric"] == "instability"]
    kinds = ", ".join(parts["part"].str.rsplit("_", n=1).str[0].unique())
    return [
        f"E: mean of exp(3 |change|) − 1 along a point's way (Datta et al. 2022), over sequences of "
        f"{', '.join(parts['scene'].unique())} in which moves: {kinds} (the CSV has each); at a "
        f"radius of {radii[int(shown['number'].iloc[0])]:.3g} {unit}. Of the exact shadow itself "
        f"{shown['instability_reference'].iloc[0]:.3f}. In sequences the SVGF-, FFX- and "
        "SIGMA-like filters have their history; all else in this table is of single frames."
    ]


def _describe_constants(
    chosen: Mapping[str, Mapping[str, Any]], labels: Mapping[str, str]
) -> list[str]:
    """One sentence on each method's constants, and whether one is at an end of what was tried."""
    sentences = []
    for method, record in chosen.items():
        parts = [
            f"{name} " + ", ".join(f"{one['constants'][name]:g}" for one in record["radii"])
            for name in record["tried"]
        ]
        ends = sorted({name for one in record["radii"] for name in one["at_end"]})
        end = f" ({' and '.join(ends)} at an end of what was tried)" if ends else ""
        sentences.append(f"{labels[method]}, by radius: {'; '.join(parts)}{end}.")
    if not sentences:
        return []
    return ["Constants are the best on validation frames.", *sentences]


if "snakemake" in globals():
    run_stage(snakemake, table, write_table)
