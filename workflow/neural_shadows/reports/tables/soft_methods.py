"""Methods for soft shadows on the same frames: errors, flicker, time and bytes, by radius."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from neural_shadows.evaluation.soft_metrics import read_soft_metrics
from neural_shadows.files.whole_files import read_json
from neural_shadows.metrics.intervals import mean_interval
from neural_shadows.metrics.pooled_psnr import psnr_of
from neural_shadows.reports import phrases
from neural_shadows.reports.tables.writing import interval_cells, number_cells, write_twins
from neural_shadows.running.stage import run_stage

WITH_INTERVALS = ("mse", "l1")
MEANS = (
    *("mse_umbra", "mse_penumbra", "mse_lit", "mse_edge", "false_shadow", "light_leak"),
    *("ssim", "flip", "lpips"),
)
FLICKER = ("instability", "instability_reference", "temporal_error", "temporal_error_reference")


def write(
    *,
    soft_metrics: list[Path],
    soft_times: Path,
    soft_constants: list[Path],
    lpips_json: Path,
    csv: Path,
    md: Path,
    title: str,
    labels: Mapping[str, str],
    unseen: Sequence[str],
    run: Mapping[str, Any],
) -> None:
    """Write a row for each method and radius, in the order of `labels`.

    CSV: `method, label, radius_m, mse, mse_low, mse_high, …` and all of `soft_table`.

    Args:
        soft_metrics: of each method; soft_times: what `time_soft_methods` wrote;
            soft_constants: what `tune_soft_method` wrote, in the order of `labels`.
        labels: what each method is called. unseen: scenes that no network trains on.
    """
    times, lpips = read_json(soft_times), read_json(lpips_json)
    found = read_soft_metrics(soft_metrics)
    table = soft_table(found, times, labels, unseen, run["seed"]).assign(scale=run["scale"])
    columns = {
        "method": table["label"],
        "radius m": number_cells(table["radius_m"], "{:.3g}"),
        "MSE × 10⁻⁴ ↓": interval_cells(table, ["mse", "mse_low", "mse_high"], 1, 1e4),
        "unseen scenes": number_cells(table["mse_unseen"], "{:.1f}", 1e4),
        "L1 % ↓": number_cells(table["l1"], "{:.2f}", 100),
        "PSNR dB ↑": number_cells(table["psnr_pooled"], "{:.1f}"),
        "SSIM ↑": number_cells(table["ssim"], "{:.3f}"),
        "FLIP ↓": number_cells(table["flip"], "{:.4f}"),
        "LPIPS ↓": number_cells(table["lpips"], "{:.4f}"),
        "false shadow %": number_cells(table["false_shadow"], "{:.2f}", 100),
        "light leak %": number_cells(table["light_leak"], "{:.2f}", 100),
        "flicker E": number_cells(table["instability"], "{:.3f}"),
        "ms": number_cells(table["ms"], "{:.1f}"),
        "KiB": number_cells(table["bytes"] / 1024, "{:,.0f}"),
    }
    columns = {name: cells for name, cells in columns.items() if any(cells)}
    chosen = {one["method"]: one for one in map(read_json, soft_constants)}
    notes = [
        f"Mean over {table['frames'].iloc[0]} frames of {times['width']} × {times['height']} in "
        f"{found['scene'].nunique()} scenes [95 % bootstrap interval over frames]; *unseen scenes*: "
        f"{', '.join(unseen) or 'none'}. The exact soft shadow is by rays from eight places a pixel.",
        "A pixel counts if it shows a surface inside the light's map. What faces away from the "
        "light is dark for all methods alike.",
        *_describe_constants(chosen, labels, times["radii"]),
        f"ms: median of {times['frames']} frames, each the median of {times['repeats']}, one thread "
        f"of {times['machine']['cpu']}; methods that look at a map have {times['map_ms']:.1f} ms of "
        "rasterising it in theirs. KiB: the map, with its moments. What only needs rays has none, but the mesh and "
        "its tree, which all have for the primary rays.",
        f"E: mean of exp(3 |change|) − 1 along a point's way through sequences, at a radius of "
        f"{times['radii'][len(times['radii']) // 2]:.3g} m; of the exact shadow itself "
        f"{table['instability_reference'].mean():.3f}, as light and object do move.",
        phrases.describe_lpips(lpips),
        phrases.describe_run(run),
    ]
    write_twins(table, columns, csv, md, title=title, notes=notes)


def soft_table(
    found: pd.DataFrame,
    times: Mapping[str, Any],
    labels: Mapping[str, str],
    unseen: Sequence[str],
    seed: int,
) -> pd.DataFrame:
    """A row for each method and radius.

    Columns: `method, label, radius, radius_m, frames`, of `mse` and `l1` also the ends of their
    intervals, the other means, `psnr_pooled`, `mse_unseen`, the flicker's, `own_ms`, `map_ms`, `ms`,
    `bytes`.
    """
    frames = found[~found["metric"].isin(FLICKER)]
    rows = []
    for method, label in labels.items():
        mine = frames[frames["method"] == method]
        # What a buffer holds already takes no time of its own.
        timed = times["methods"].get(method, {"ms": [np.nan] * len(times["radii"])})
        floats = timed.get("texel_floats", 0)
        for radius, length in enumerate(times["radii"]):
            here = mine[mine["radius"] == radius]
            values = {name: one["value"].to_numpy() for name, one in here.groupby("metric")}
            row = {"method": method, "label": label, "radius": radius, "radius_m": length}
            row["frames"] = len(values["mse"])
            for name in WITH_INTERVALS:
                ends = mean_interval(values[name], seed)
                row |= dict(zip((name, f"{name}_low", f"{name}_high"), ends))
            # Of a part that no frame has, there is no mean.
            row |= {name: _mean(values.get(name, np.array([]))) for name in MEANS}
            row["psnr_pooled"] = float(psnr_of(max(row["mse"], 1e-10)))
            some = here[here["scene"].isin(unseen) & (here["metric"] == "mse")]["value"]
            row["mse_unseen"] = _mean(some.to_numpy())
            row["own_ms"] = timed["ms"][radius]
            row["map_ms"] = times["map_ms"] * (floats > 0)
            row["ms"] = row["own_ms"] + row["map_ms"]
            row["bytes"] = 4 * floats * times["texels"]
            rows.append(row)
    table = pd.DataFrame(rows)
    flicker = found[found["metric"].isin(FLICKER)]
    if flicker.empty:
        return table.assign(**dict.fromkeys(FLICKER, np.nan))
    means = flicker.pivot_table("value", ["method", "radius"], "metric").reset_index()
    return table.merge(means, on=["method", "radius"], how="left")


def _mean(values: np.ndarray) -> float:
    known = values[~np.isnan(values)]
    return float(known.mean()) if len(known) else float("nan")


def _describe_constants(
    chosen: Mapping[str, Mapping[str, Any]], labels: Mapping[str, str], radii: Sequence[float]
) -> list[str]:
    """One sentence on each method's constants, and whether one is at an end of what was tried."""
    sentences = []
    for method, record in chosen.items():
        if not record["tried"]:
            continue
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
    run_stage(snakemake, write)
