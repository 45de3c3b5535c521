"""Flicker of screen-space networks, with and without TAA (NSM, figures 5, 6)."""

from typing import Literal

import pandas as pd
from pydantic import Field

from neural_shadows.frames.uses import RUN_IN, use_of
from neural_shadows.metrics.kinds.sequences import ERRORS
from neural_shadows.metrics.registry import metrics
from neural_shadows.reports.data.frame_means import by_frame, mean_over_scenes
from neural_shadows.reports.data.quality_cells import metric_column
from neural_shadows.reports.data.soft_frames import TrainedFrames, learned_rows
from neural_shadows.reports.data.table import Table, numbers
from neural_shadows.sections.frame_tables import MethodsTable
from neural_shadows.settings.base import Name

# Endings of labels by those of metrics, see `sequences.SHOWN`.
ENDINGS = {
    "": "",
    "_single": ", no history",
    "_taa": " + TAA",
    "_recursive": " + recursive TAA",
}


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
    from neural_shadows.denoising.taa import REST
    from neural_shadows.frames.draw_sequences import STEP

    whole, lights = temporal_table(soft), soft.lights
    table = learned_rows(whole)
    kinds = [name.removeprefix("e_") for name in table if name.startswith("e_")]
    columns = {
        "method": table["label"],
        **{f"E, {kind}": numbers(table[f"e_{kind}"], "{:.4f}") for kind in kinds},
        **{f"exact, {kind}": numbers(table[f"reference_{kind}"], "{:.4f}") for kind in kinds},
        f"{metrics()['mse'].label} in sequences": metric_column(table, "mse", "mse_sequence"),
        "in sequences, off edges": metric_column(table, "mse", "mse_sequence_off_edges"),
        "of changes, off edges": metric_column(table, "mse", "mse_change_off_edges"),
        f"{metrics()['mse'].label} at edges": metric_column(table, "mse_edge"),
        "edge width, px": numbers(table["edge_width"], "{:.1f}"),
        "exact": numbers(table["edge_width_reference"], "{:.1f}"),
    }
    notes = [
        "E: mean of exp(3 |change|) − 1 along a point's motion over a sequence (3.4), by what moves "
        "in it. Exact: E of the exact shadow, which truly changes with a moving light. Blur lowers E, "
        "so the squared error stands beside it; also off the geometry's edges: at these a blur has less "
        "than the exact shadow of a pixel's centre. Of changes: squared differences of a point's "
        "change and the exact shadow's. Where this changes, blur and lag leave an error; where not, "
        "they lower it, as they lower noise.",
        f"Sequences are of {', '.join(_moving(soft))}, with a {lights[len(lights) // 2]}. What moves "
        f"goes {STEP:.1%} of the scene's size a frame, for some frames: lag has only begun. A filter "
        f"with a history of its own begins with {RUN_IN} frames at rest.",
        "TAA stands behind single frames, in the place of such a history: each frame averaged with "
        "the one before, at points seen in both, as in the text. Recursive, as engines have it: a "
        "tenth of each frame is added to what was shown before, looked up by a cubic spline and clipped to one standard deviation "
        "about the mean of 3 × 3 pixels; where rays differ it begins with the mean of the first frame "
        f"and {REST} at rest. Filters behind TAA have their constants for single frames.",
        "Edges: within 3 pixels of a point light's shadow edges, in test frames, of all lights. Edge "
        "width: how sharp a point light's edges are; the area with visibilities of 10 to 90 % near "
        "them, × 1.25, over their length, where the picture has an edge, too; about 8 at most.",
        *soft.notes(),
    ]
    return Table(whole, columns, notes)


def temporal_table(soft: TrainedFrames) -> pd.DataFrame:
    """Tabulate flicker by method, as it is and with TAA, and by null predictor, as it is.

    A null predictor among the methods has rows of both sorts, so that claims are tried with it.

    Columns: `method`, `label`, `null` (its name, None of a method), `shown`, of `ENDINGS`; by what moves in a
    sequence `e_camera`, …, and `reference_camera`, …, of the exact shadow; `sequences.ERRORS`, in all and by what
    moves; of test frames, NaN with TAA, `mse_edge`, and of a point light, NaN without one, `edge_width` and
    `edge_width_reference`, pixels.
    """
    rows = []
    methods = [(method, label, None) for method, label in soft.labels.items()]
    nulls = [(null, label, null) for null, label in soft.nulls.items()]
    for method, label, null in [*methods, *nulls]:
        own = soft.errors[soft.errors["method"] == method]
        for shown, ending in ENDINGS.items() if null is None else [("", "")]:
            if shown == "_single" and not (own["metric"] == "instability_single").any():
                continue  # it has no other history
            row = {"method": method, "label": f"{label}{ending}", "shown": shown, "null": null}
            row |= _by_kind(own, f"instability{shown}", "e")
            row |= _by_kind(own, "instability_reference", "reference")
            for name in ERRORS:
                row[name] = _mean(own, f"{name}{shown}")
                row |= _by_kind(own, f"{name}{shown}", name)
            frames = own[:0] if shown else own
            row["mse_edge"] = _mean(frames, "mse_edge")
            row |= {name: _mean(frames, name) for name in ("edge_width", "edge_width_reference")}
            rows.append(row)
    return pd.DataFrame(rows)


def _moving(soft: TrainedFrames) -> list[str]:
    errors = soft.errors
    return [*errors[errors["metric"] == "instability"]["scene"].unique()]


def _by_kind(errors: pd.DataFrame, metric: str, prefix: str) -> dict[str, float]:
    rows = errors[errors["metric"] == metric]
    means = rows.groupby(rows["part"].map(use_of), sort=False)["value"].mean()
    return {f"{prefix}_{kind}": value for kind, value in means.items()}


def _mean(errors: pd.DataFrame, metric: str) -> float:
    return mean_over_scenes(by_frame(errors, metric))
