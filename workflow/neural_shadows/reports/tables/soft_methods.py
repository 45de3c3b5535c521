"""Methods for soft shadows on the same frames: errors, flicker, time and bytes, by radius."""

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, Literal

import numpy as np
import pandas as pd
from pydantic import Field

from neural_shadows.evaluation.null_predictors import NULL
from neural_shadows.evaluation.registry import frame_method
from neural_shadows.files.whole_files import read_json
from neural_shadows.frames.uses import use_of
from neural_shadows.layout import tables
from neural_shadows.layout.layout import Layout
from neural_shadows.metrics.kinds import sequences
from neural_shadows.metrics.pooled_psnr import psnr_of
from neural_shadows.metrics.registry import metric_in, metrics
from neural_shadows.reports.data import phrases
from neural_shadows.reports.data.frame_means import (
    ABOUT_EDGES,
    OFF_EDGES,
    describe_units,
    mean_over_scenes,
    mean_with_interval,
)
from neural_shadows.reports.data.lights import light_name
from neural_shadows.reports.data.quality_cells import metric_column
from neural_shadows.reports.data.soft_costs import cost, describe_bytes, describe_times
from neural_shadows.reports.data.soft_frames import SoftFrames, describe_trainings
from neural_shadows.reports.data.table import Table, filled, numbers, with_ends
from neural_shadows.sections.frame_tables import MethodsTable
from neural_shadows.sections.sections import Sections
from neural_shadows.settings.base import Name, check_among
from neural_shadows.settings.records import SoftTimes, Tuned, TunedRadius

WITH_INTERVALS = ("mse", OFF_EDGES, "l1")
ERRORS = ("mse", OFF_EDGES)
PARTS = ("mse_umbra", "mse_penumbra", "mse_lit", "mse_edge")
SHARES = ("false_shadow", "light_leak")
IMAGES = {"ssim": 3, "flip": 4, "lpips": 4}  # digits
MEANS = (*PARTS, *SHARES, *IMAGES)
DIFFERENCE = "off_edges_difference"
FLICKER = (
    *(f"instability{of}" for of in (*sequences.SHOWN, "_reference")),
    *(f"temporal_error{of}" for of in (*sequences.SHOWN, "_reference")),
    *sequences.METRICS,
)


class Settings(MethodsTable):
    """Methods for soft shadows on a frame set, by light: errors, flicker, time, bytes."""

    own_chapter = "soft"
    kind: Literal["soft_methods"] = Field(description="`soft_methods`")
    methods: list[Name] = Field(
        min_length=1,
        description="keys of `METHODS` in evaluation/methods/, or networks, in the table's "
        "order; `no_shadow` and `all_dark` are always added",
    )
    more_metrics: list[metric_in("soft")] = Field(
        [], description="further metrics of `metrics/kinds`, as columns"
    )
    against: Name | None = Field(
        None, description="the row whose paired differences to all others are given"
    )

    def methods_shown(self) -> list[str]:
        return self.methods

    def check(self, config: Sections, key: str) -> None:
        super().check(config, key)
        if self.against is not None:
            check_among(f"{key}.against", self.against, self.methods)

    def resolved(self, config: Sections) -> dict[str, Any]:
        missing = [null for null in NULL if null not in self.methods]
        return self.model_dump() | {"methods": [*self.methods, *missing]}


def params(layout: Layout, table: str) -> dict[str, Any]:
    frames = layout.entry("frame_sets", tables.frame_set(layout, table))
    return {
        "left_out": tables.left_out(layout, table),
        "unseen": frames.get("unseen", []),
        "tuned_also_on": frames.get("tuned_also_on"),
    }


def table(
    soft: SoftFrames,
    soft_times: Path | None,
    soft_constants: list[Path],
    lpips_json: Path,
    left_out: Sequence[str],
    unseen: Sequence[str],
    tuned_also_on: str | None = None,
    more_metrics: Sequence[str] = (),
    against: str | None = None,
) -> Table:
    """Tabulate errors and costs by radius and method, in the order of `soft.labels`.

    CSV: all columns of `soft_table`, and the scale.

    Args:
        soft_times: of `time_methods`, None for frames without a scene.
        soft_constants: of `tune`.
        left_out: labels of methods not available on this machine.
        unseen: scenes that no network trains on.
        tuned_also_on: another frame set on which constants were chosen.
        more_metrics: further columns.
        against: the method of paired differences; None for no differences.
    """
    about, labels, lpips = soft.about, soft.labels, read_json(lpips_json)
    times = read_json(soft_times) if soft_times else {"methods": {}}
    errors, radii, unit = soft.errors, soft.radii, soft.unit
    table = soft_table(errors, radii, times, labels, unseen, more_metrics, against).assign(
        unit=unit
    )
    known = metrics()
    columns = {
        "light": [light_name(radius, unit) for radius in table["radius"]],
        "method": table["label"],
        known["mse"].heading: metric_column(table, "mse", interval=True),
        known[OFF_EDGES].part: metric_column(table, OFF_EDGES, interval=True),
        "unseen scenes": metric_column(table, "mse", "mse_unseen"),
        "unseen, off edges": metric_column(table, OFF_EDGES, "off_edges_unseen"),
        "difference, off edges": metric_column(
            table, OFF_EDGES, DIFFERENCE, interval=True, sign="+"
        ),
        **{known[name].part: metric_column(table, name) for name in PARTS},
        "PSNR dB ↑": metric_column(table, "psnr_pooled", digits=1),
        **{
            known[name].heading: metric_column(table, name, digits=digits)
            for name, digits in IMAGES.items()
        },
        **{known[name].label: metric_column(table, name) for name in (*SHARES, "instability")},
        **{known[name].heading: metric_column(table, name) for name in more_metrics},
        "ms": numbers(table["ms"], "{:.1f}"),
        "KiB": numbers(table["bytes"] / 1024, "{:,.0f}"),
    }
    records = {record["method"]: record for record in map(read_json, soft_constants)}
    tuned = {name: frame_method(name).tuned_as or name for name in labels}
    chosen = {name: records[key] for name, key in tuned.items() if key in records}
    scenes, frames = [*errors["scene"].unique()], table["frames"].iloc[0]
    parts = (
        f"Mean over {frames} frames of {about['width']} × {about['height']} in {len(scenes)} scenes "
        f"[{describe_units(scenes, frames)}]; "
    )
    notes = [
        f"{parts}unseen scenes: {', '.join(unseen) or 'none'}. The reference is traced with rays from "
        "eight points of each pixel.",
        *soft.describe_widths(scenes),
        "Squared errors: umbra, penumbra and lit by the reference's visibility (below 2 %, between, "
        "above 98 %); edge: within 3 pixels of a point light's shadow edges. A pixel counts if it shows "
        "a surface inside the light map. Surfaces facing away from the light's centre are dark for all "
        "methods but rays. FLIP and LPIPS are of the first frame of each part and the middle light.",
        *([ABOUT_EDGES] if table[OFF_EDGES].notna().any() else []),
        *_describe_difference(
            table, labels.get(against), "unseen scenes" if unseen else "all scenes"
        ),
        *_describe_orders(table, radii, unit),
        *_describe_constants(chosen, labels, tuned_also_on),
        *describe_times(times),
        *describe_bytes(times),
        *describe_trainings(soft.records, labels),
        *_describe_flicker(table, errors, radii, unit),
        *([f"Not available on this machine: {', '.join(left_out)}."] if left_out else []),
        phrases.describe_lpips(lpips),
    ]
    return Table(table, filled(columns), notes)


def soft_table(
    errors: pd.DataFrame,
    radii: Sequence[float],
    times: SoftTimes,
    labels: Mapping[str, str],
    unseen: Sequence[str],
    more_metrics: Sequence[str] = (),
    against: str | None = None,
) -> pd.DataFrame:
    """Tabulate errors and costs by radius and method.

    Columns: `method, label, number` (of the radius, from 0), `radius, frames`, of `mse`, `mse_off_edges`
    and `l1` also the ends of their intervals, the other means, `psnr_pooled`, `mse_unseen`,
    `off_edges_unseen`, `off_edges_difference` with its ends (see `_difference`), `own_ms`, `map_ms`, `ms`,
    `bytes`, those of `_flicker`.
    """
    frames = errors[~errors["metric"].isin(FLICKER)]
    means = dict.fromkeys([*MEANS, *(n for n in more_metrics if n not in WITH_INTERVALS)])
    rows = []
    for number, radius in enumerate(radii):
        of_light = frames[frames["radius"] == number]
        for method, label in labels.items():
            own = of_light[of_light["method"] == method].set_index("scene")
            row = {"method": method, "label": label, "number": number, "radius": radius}
            row["frames"] = int((own["metric"] == "mse").sum())
            for name in WITH_INTERVALS:
                row |= mean_with_interval(own[own["metric"] == name]["value"], name)
            row |= {n: mean_over_scenes(own[own["metric"] == n]["value"]) for n in means}
            row["psnr_pooled"] = float(psnr_of(max(row["mse"], 1e-10)))
            new = own[own.index.isin(unseen)]
            row["mse_unseen"] = mean_over_scenes(new[new["metric"] == "mse"]["value"])
            row["off_edges_unseen"] = mean_over_scenes(new[new["metric"] == OFF_EDGES]["value"])
            row |= _difference(of_light, method, against, unseen)
            rows.append(row | cost(times, method, number))
    table = pd.DataFrame(rows)
    return table.merge(_flicker(errors), on=["method", "number"], how="left")


def _difference(
    of_light: pd.DataFrame, method: str, against: str | None, unseen: Sequence[str]
) -> dict[str, float]:
    """A method's squared error off edges less that of `against` on the same frames, with its interval.

    Of the unseen scenes where the frame set has them, else of all. NaN for `against` itself.
    """
    rows = of_light[of_light["metric"] == OFF_EDGES]
    if unseen:
        rows = rows[rows["scene"].isin(unseen)]
    wide = rows.pivot(index=["scene", "part", "frame"], columns="method", values="value")
    if method == against or not {method, against} <= {*wide}:
        return dict.fromkeys(with_ends(DIFFERENCE), np.nan)
    return mean_with_interval(wide[method] - wide[against], DIFFERENCE)


def _describe_difference(table: pd.DataFrame, other: str | None, scenes: str) -> list[str]:
    if table[DIFFERENCE].isna().all():
        return []
    return [
        f"Difference: a method's squared error off edges less that of {other}, on the same frames of "
        f"{scenes} [95 %, paired]. Above 0 the method errs more."
    ]


def _flicker(errors: pd.DataFrame) -> pd.DataFrame:
    """Mean flicker by method and radius, and by kind of sequence (`instability_camera`, …)."""
    flicker = errors[errors["metric"].isin(FLICKER)].rename(columns={"radius": "number"})
    kind = flicker["part"].map(use_of)
    index = ["method", "number"]
    means = flicker.pivot_table("value", index, "metric").reindex(columns=FLICKER)
    by_kind = flicker.assign(column=flicker["metric"] + "_" + kind)
    return means.join(by_kind.pivot_table("value", index, "column")).reset_index()


def _describe_orders(table: pd.DataFrame, radii: Sequence[float], unit: str) -> list[str]:
    """Count pairs of methods in contrary order by the two errors, by light."""
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
    table: pd.DataFrame, errors: pd.DataFrame, radii: Sequence[float], unit: str
) -> list[str]:
    shown = table.dropna(subset="instability")
    if shown.empty:
        return []
    parts = errors[errors["metric"] == "instability"]
    kinds = ", ".join(parts["part"].map(use_of).unique())
    return [
        f"E: mean of exp(3 |change|) − 1 along a point's motion (Datta et al. 2022), over sequences of "
        f"{', '.join(parts['scene'].unique())} with a moving: {kinds} (the CSV has each), at a "
        f"radius of {radii[int(shown['number'].iloc[0])]:.3g} {unit}. E of the reference: "
        f"{shown['instability_reference'].iloc[0]:.3f}. In sequences the SVGF-, FFX- and "
        "SIGMA-like filters have their history; all other columns are of single frames. The CSV has the "
        "squared errors of sequences, also off edges."
    ]


_BOUNDS = {
    ("light", 0): "A `light` of 0 is Open Image Denoise's network for colours of any range.",
    ("width", 0): "A `width` of 0 is no filter.",
    ("passes", 0): "With 0 `passes` nothing is filtered.",
    ("share", 0): "With a `share` of 0 frames after the eighth only bound the history.",
    ("clamp", 0): "A `clamp` of 0 puts the mean of the pixels around in the history's place.",
    ("share", 1): "A `share` of 1 takes the new frame alone, without the history.",
}


def _describe_constants(
    chosen: Mapping[str, Tuned], labels: Mapping[str, str], tuned_also_on: str | None
) -> list[str]:
    """Describe each method's constants, and those at an end of their range."""
    sentences, tried = [], set()
    for method, record in chosen.items():
        candidates = record["candidates"]
        sentence = f"{labels[method]}, by radius: {_describe_choices(candidates, record['radii'])}"
        if "history" in record:
            candidates = candidates | record["of_history"]
            of_history = _describe_choices(record["of_history"], [record["history"]])
            sentence += f"; of its history, on validation sequences: {of_history}"
        tried |= {(name, value) for name, values in candidates.items() for value in values}
        sentences.append(f"{sentence}.")
    if not sentences:
        return []
    also = f", also on those of {tuned_also_on}" if tuned_also_on else ""
    bounds = [text for bound, text in _BOUNDS.items() if bound in tried]
    return [f"Constants are the best on validation frames{also}.", *sentences, *bounds]


def _describe_choices(names: Iterable[str], choices: Sequence[TunedRadius]) -> str:
    parts = [
        f"{name} " + ", ".join(f"{choice['constants'][name]:g}" for choice in choices)
        for name in names
    ]
    ends = sorted({name for choice in choices for name in choice["at_end"]})
    end = f" ({' and '.join(ends)} at an end of the range tried)" if ends else ""
    return "; ".join(parts) + end
