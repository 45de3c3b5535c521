"""Networks of several depths by width of penumbrae (NSM, table 1)."""

from collections.abc import Mapping
from pathlib import Path
from typing import Literal

import numpy as np
import pandas as pd
from pydantic import Field

from neural_shadows.reports.data.digits import short
from neural_shadows.reports.data.frame_means import squared_errors
from neural_shadows.reports.data.published import printed_column, read_published, with_printed
from neural_shadows.reports.data.soft_frames import TrainedFrames, learned_rows
from neural_shadows.reports.data.table import Table, filled, number_cells, numbers
from neural_shadows.sections.frame_tables import ColumnsTable
from neural_shadows.settings.records import TrainingRecord

SUFFICES = 2.0  # times a row's least error: a worse network has too few levels (claim 3.6)


class Settings(ColumnsTable):
    """Trained networks of several depths on penumbrae of several widths."""

    published: str | None = Field(
        None, pattern=r"^nsm\.1$", description="`nsm.` and the paper's number of this table"
    )
    kind: Literal["screen_depth"] = Field(description="`screen_depth`")


def table(
    soft: TrainedFrames,
    published_nsm_csv: Path,
    published: str | None,
    columns: Mapping[str, str],
) -> Table:
    """Tabulate squared errors by scene and network, for the largest light.

    CSV: those of `depth_table`, printed numbers and differences, and the scale.

    Args:
        published: the paper's number of the table; None without printed numbers.
        columns: the experiment of each printed column.
    """
    about, labels = soft.about, soft.labels
    whole = depth_table(soft, columns)
    printed = printed_column(
        read_published(published_nsm_csv), published, whole["row"], whole["column"]
    )
    whole = with_printed(whole, "mse", printed)
    table = learned_rows(whole)
    parts = {
        "penumbra": [row.replace("penumbra_", "") + " px" for row in table["row"].unique()],
    }
    for column, label in zip(columns, (labels[name] for name in columns.values())):
        part = table[table["column"] == column]
        parts[label] = numbers(part["mse"], "{:.4f}")
        parts[f"{label}, printed"] = numbers(part["printed_mse"], "{:.3f}")
    for heading, name, form in (
        ("of the widest", "mse_widest", "{:.4f}"),
        ("× best", "ratio", "{:.1f}"),
    ):
        rows = table.groupby("row", sort=False)[name]
        parts[heading] = [" / ".join(number_cells(values, form)) for _, values in rows]
    notes = [
        f"Squared error of visibility for a {soft.lights[-1]}, mean over the test "
        f"frames of {about['width']} × {about['height']}. × best: the error over the least of its "
        "row; a network with a receptive field (3 · 2^levels pixels) narrower than the "
        f"penumbra should have {SUFFICES:g} or more. Of the widest: of the tenth of each frame's penumbra "
        "pixels with the widest penumbrae by the paper's model (3.6).",
        _describe_learning(soft.records, labels),
        *soft.notes(),
    ]
    return Table(whole, filled(parts), notes)


def depth_table(soft: TrainedFrames, columns: Mapping[str, str]) -> pd.DataFrame:
    """Tabulate errors by scene and network or null predictor.

    Columns: `row` (`penumbra_21` of the scene `plate_21`), `column`, `experiment`, `label`, `null`
    (see `TrainedFrames.null_of`), `receptive_field` in pixels, `mse` and `mse_off_edges` with the
    ends of their intervals over a scene's frames, `mse_widest` of the tenth of a frame's penumbra
    pixels with the widest penumbrae, `ratio` of `mse` to the least of its row.
    """
    rows, nulls, labels = [], soft.nulls, soft.labels_and_nulls
    largest = soft.errors["radius"] == len(soft.about["radii"]) - 1
    for scene, frames in soft.errors[largest].groupby("scene", sort=False):
        for column, experiment in [*columns.items(), *zip(nulls, nulls)]:
            null = soft.null_of(experiment)
            own = frames[frames["method"] == experiment]
            levels = 0 if null else len(soft.records[experiment]["network"].get("widths", ()))
            row = {"row": scene.replace("plate_", "penumbra_"), "column": column, "null": null}
            row |= {"experiment": experiment, "label": labels[experiment]}
            row |= {"receptive_field": 3 * 2**levels if levels else np.nan}
            widest = own[own["metric"] == "mse_widest"]["value"].mean()
            rows.append(row | squared_errors(own) | {"mse_widest": widest})
    table = pd.DataFrame(rows)
    least = table[table["null"].isna()].groupby("row")["mse"].min()
    return table.assign(ratio=table["mse"] / table["row"].map(least))


def _describe_learning(records: Mapping[str, TrainingRecord], labels: Mapping[str, str]) -> str:
    """Describe errors over steps: a deeper network may only lack training."""
    texts = []
    for name, record in records.items():
        validations = record["validations"]
        quarters = np.linspace(0, len(validations) - 1, 4).round().astype(int)
        shown = [validations[number] for number in dict.fromkeys(quarters)]
        errors = number_cells([np.mean(point["mse"], dtype=float) for point in shown], short, 1e4)
        after = [f"{error} after {point['step']:,}" for error, point in zip(errors, shown)]
        texts.append(f"{labels.get(name, name)} {', '.join(after)}")
    return (
        "An error that falls until the end is of a network short of training. Squared error × 10⁻⁴ on "
        f"validation frames, mean over all lights, by steps: {'; '.join(texts)}."
    )
