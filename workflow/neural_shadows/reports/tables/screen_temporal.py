"""Flicker of screen-space networks, with and without TAA (NSM, figures 5, 6)."""

from typing import Literal

import pandas as pd
from pydantic import Field

from neural_shadows.frames.uses import RUN_IN, use_of
from neural_shadows.metrics.registry import metrics
from neural_shadows.reports.data.quality_cells import metric_column
from neural_shadows.reports.data.soft_frames import TrainedFrames, learned_rows
from neural_shadows.reports.data.table import Table, numbers
from neural_shadows.sections.frame_tables import MethodsTable
from neural_shadows.settings.base import Name

# Endings of labels and of metrics, by `taa`.
TAA = {
    None: ("", ""),
    "one frame": (" + TAA", "_taa"),
    "recursive": (" + recursive TAA", "_recursive"),
}
_ERRORS = ("mse_sequence", "mse_sequence_off_edges", "mse_change")


class Settings(MethodsTable):
    """Flicker of methods on a frame set's sequences, with and without TAA."""

    kind: Literal["screen_temporal"] = Field(description="`screen_temporal`")
    methods: list[Name] = Field(
        min_length=1, description="as those of `soft_methods`, in the table's order"
    )

    def methods_shown(self) -> list[str]:
        return self.methods

    def needs_sequence(self) -> bool:
        return True


def table(soft: TrainedFrames) -> Table:
    """Tabulate flicker by method, with and without TAA.

    CSV: those of `temporal_table`, and the scale.
    """
    whole, lights = temporal_table(soft), soft.lights
    table = learned_rows(whole)
    kinds = [name.removeprefix("e_") for name in table if name.startswith("e_")]
    columns = {
        "method": table["label"],
        **{f"E, {kind}": numbers(table[f"e_{kind}"], "{:.4f}") for kind in kinds},
        **{f"exact, {kind}": numbers(table[f"reference_{kind}"], "{:.4f}") for kind in kinds},
        f"{metrics()['mse'].label} in sequences": metric_column(table, "mse", "mse_sequence"),
        "in sequences, off edges": metric_column(table, "mse", "mse_sequence_off_edges"),
        "of changes": metric_column(table, "mse", "mse_change"),
        f"{metrics()['mse'].label} at edges": metric_column(table, "mse_edge"),
        "edge width, px": numbers(table["edge_width"], "{:.1f}"),
        "exact": numbers(table["edge_width_reference"], "{:.1f}"),
    }
    notes = [
        "E: mean of exp(3 |change|) − 1 along a point's motion over a sequence (3.4), by what moves "
        "in it. Exact: E of the exact shadow, which truly changes with a moving light. Blur lowers E, "
        "so the squared error stands beside it; also off the geometry's edges: at these a blur has less "
        "than the exact shadow of a pixel's centre. Of changes: squared differences of a point's change and the exact "
        "shadow's, which neither blur nor lag lowers.",
        f"Sequences have a {lights[len(lights) // 2]}. TAA: each frame averaged with the one before, "
        "at points seen in both, as in the text; recursive TAA: a tenth of each frame is added to what was shown before, "
        "clipped to one standard deviation about the mean of 3 × 3 pixels, as engines do it behind any method. "
        f"What has a history begins with {RUN_IN} frames at rest in the first "
        "view. Edges: within 3 pixels of a point light's shadow edges, in test frames, of all lights. Edge "
        "width: how sharp a point light's edges are; the area with visibilities of 10 to 90 % near them, × 1.25, over "
        "their length, where the picture has an edge, too; about 8 at most.",
        *soft.notes(),
    ]
    return Table(whole, columns, notes)


def temporal_table(soft: TrainedFrames) -> pd.DataFrame:
    """Tabulate flicker by method, without and with TAA, and by null predictor, without.

    A null predictor among the methods has a row of either kind, so that claims are tried with it.

    Columns: `method`, `label`, `null` (its name, None of a method), `taa` (of `TAA`); by what moves in a
    sequence `e_camera`, …, and `reference_camera`, …, of the exact shadow; `mse_sequence`,
    `mse_sequence_off_edges`, `mse_change`; of test frames, NaN with TAA, `mse_edge`, and of a point light, NaN without
    one, `edge_width` and `edge_width_reference`, pixels.
    """
    rows = []
    methods = [(method, label, None) for method, label in soft.labels.items()]
    nulls = [(null, label, null) for null, label in soft.nulls.items()]
    for method, label, null in [*methods, *nulls]:
        own = soft.errors[soft.errors["method"] == method]
        for taa in TAA if null is None else [None]:
            end, shown = TAA[taa]
            row = {"method": method, "label": f"{label}{end}", "taa": taa, "null": null}
            row |= _by_kind(own, f"instability{shown}", "e")
            row |= _by_kind(own, "instability_reference", "reference")
            row |= {name: _mean(own, f"{name}{shown}") for name in _ERRORS}
            frames = own if taa is None else own[:0]
            row["mse_edge"] = _mean(frames, "mse_edge")
            row |= {name: _mean(frames, name) for name in ("edge_width", "edge_width_reference")}
            rows.append(row)
    return pd.DataFrame(rows)


def _by_kind(errors: pd.DataFrame, metric: str, prefix: str) -> dict[str, float]:
    rows = errors[errors["metric"] == metric]
    means = rows.groupby(rows["part"].map(use_of), sort=False)["value"].mean()
    return {f"{prefix}_{kind}": value for kind, value in means.items()}


def _mean(errors: pd.DataFrame, metric: str) -> float:
    return float(errors[errors["metric"] == metric]["value"].mean())
