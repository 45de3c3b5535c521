"""Errors of screen-space networks by their features (NSM, table S1)."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Literal

import pandas as pd
from pydantic import Field

from neural_shadows.files.whole_files import read_json
from neural_shadows.frames.feature_names import FEATURES
from neural_shadows.layout import tables
from neural_shadows.layout.layout import Layout
from neural_shadows.reports.data.frame_means import describe_sample, squared_errors
from neural_shadows.reports.data.published import printed_column, read_published, with_printed
from neural_shadows.reports.data.soft_frames import TrainedFrames, learned_rows
from neural_shadows.reports.data.table import (
    Table,
    filled,
    intervals,
    numbers,
    with_ends,
)
from neural_shadows.sections.frame_tables import ColumnsTable, OfAnyScenes
from neural_shadows.settings.records import FeatureShare

LEAST_SHARE = 0.015  # of sensitivity, of the paper's features (3.2)


class Settings(ColumnsTable):
    """Trained networks by sets of features."""

    published: str | None = Field(
        None, pattern=r"^nsm\.s1$", description="`nsm.` and the paper's number of this table"
    )
    kind: Literal["screen_features"] = Field(description="`screen_features`")
    over: OfAnyScenes = "all"


def params(layout: Layout, table: str) -> dict[str, Any]:
    return {"measured": tables.shown_scenes(layout, table)}


def table(
    soft: TrainedFrames,
    sensitivities: list[Path],
    published_nsm_csv: Path,
    published: str | None,
    columns: Mapping[str, str],
    measured: Sequence[str],
) -> Table:
    """Tabulate error and sensitivities by set of features.

    CSV: those of `features_table`, printed errors and differences, and the scale.

    Args:
        sensitivities: of `measure_sensitivity`, of each network.
        published: the paper's number of the table.
        columns: the experiment of each printed row.
        measured: the scenes whose frames count.
    """
    soft = soft.of_scenes(measured)
    shares = {path.stem: read_json(path)["features"] for path in sensitivities}
    whole = features_table(soft, columns, shares)
    # The paper gives two of these in its text (3.2) and the others in table S1.
    printed_numbers = read_published(published_nsm_csv).rename(
        index={"nsm.features": "nsm.s1"}, level=0
    )
    printed = printed_column(printed_numbers, published, whole["row"], "error")
    whole = with_printed(whole, "error", printed)
    table = learned_rows(whole)
    sensitivity = [
        ", ".join(f"{name} {100 * part['share']:.1f}" for name, part in _sorted(shares[experiment]))
        for experiment in table["experiment"]
    ]
    cells = {
        "features": table["label"],
        "channels": numbers(table["channels"], "{:.0f}"),
        "MSE × 10⁻³": intervals(table, with_ends("error"), 2, 1e3),
        "off edges × 10⁻³": numbers(table["error_off_edges"], "{:.2f}", 1e3),
        "printed × 10⁻³": numbers(table["printed_error"], "{:.2f}", 1e3),
        "difference": numbers(table["error_minus_printed"], "{:+.2f}", 1e3),
        "sensitivity, %": sensitivity,
    }
    notes = [
        "Mean over test frames and all lights, a point among them "
        f"[{describe_sample(soft.errors)}]; the paper does not name its "
        "error; its numbers fit a squared one.",
        "Sensitivity: mean absolute change of the output with noise of a tenth of a feature's standard "
        "deviation, as a share of all features'. The paper drops features with less than "
        f"{100 * LEAST_SHARE:g} %.",
        *soft.notes(),
    ]
    return Table(whole, filled(cells), notes)


def features_table(
    soft: TrainedFrames,
    columns: Mapping[str, str],
    shares: Mapping[str, Mapping[str, FeatureShare]],
) -> pd.DataFrame:
    """Tabulate errors and sensitivities by network, with null predictors.

    Columns: `row`, the paper's; `null` (see `TrainedFrames.null_of`); `experiment`, `label`,
    `channels`, `error` and `error_off_edges` with the ends of their intervals, `share_NAME` of each
    feature, and `as_printed_NAME`.
    """
    rows = []
    for row, experiment in [*columns.items(), *zip(soft.nulls, soft.nulls)]:
        parts, null = shares.get(experiment, {}), soft.null_of(experiment)
        own = soft.errors[soft.errors["method"] == experiment]
        rows.append(
            {"row": row, "null": null, "experiment": experiment}
            | {"label": soft.labels_and_nulls[experiment]}
            | ({} if null else {"channels": sum(FEATURES[name] for name in parts)})
            | squared_errors(own, "error")
            | {f"share_{name}": part["share"] for name, part in parts.items()}
            | {f"as_printed_{name}": part["as_printed"] for name, part in parts.items()}
        )
    return pd.DataFrame(rows)


def _sorted(features: Mapping[str, FeatureShare]) -> list[tuple[str, FeatureShare]]:
    return sorted(features.items(), key=lambda item: -item[1]["share"])
