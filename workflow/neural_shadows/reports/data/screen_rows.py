"""Rows and notes shared by tables of screen-space networks."""

from collections.abc import Mapping

import numpy as np
import pandas as pd

from neural_shadows.evaluation.soft_registry import LABELS, UNLEARNED
from neural_shadows.settings.records import TrainingRecord

ABOUT_NULLS = (
    "The CSV also has rows of null predictors (no shadow, all dark, the light map as it is), "
    "named in `null`. A claim that also holds of them is vacuous."
)


def nulls_in(errors: pd.DataFrame) -> dict[str, str]:
    """Labels of the measured null predictors."""
    measured = set(errors["method"])
    return {method: LABELS[method] for method in UNLEARNED if method in measured}


def learned_rows(table: pd.DataFrame) -> pd.DataFrame:
    """The table without null predictors."""
    return table[table["null"].isna()] if "null" in table else table


def with_printed(
    table: pd.DataFrame, number: str | None, name: str, column: str | None, published: pd.Series
) -> pd.DataFrame:
    """Add `printed_NAME` and `NAME_minus_printed`; NaN without a printed number.

    Args:
        table: has `row`, the paper's key of each. number: the paper's of the table.
        column: the paper's name of the column; None if the table has a column of such names.
        published: see `read_published`.
    """
    columns = [column] * len(table) if column else table["column"]
    keys = [(number, *key) for key in zip(table["row"], columns)]
    table = table.assign(**{f"printed_{name}": [published.get(key, np.nan) for key in keys]})
    return table.assign(**{f"{name}_minus_printed": table[name] - table[f"printed_{name}"]})


def describe_trainings(
    records: Mapping[str, TrainingRecord], labels: Mapping[str, str]
) -> list[str]:
    """Describe trainings, equal ones together, and name diverged ones."""
    names_by_text: dict[str, list[str]] = {}
    diverged = [
        f"{labels.get(name, name)} at step {record['died_at_step']}"
        for name, record in records.items()
        if record["died_at_step"] is not None
    ]
    for name, record in records.items():
        training = record["training"]
        begins = f" from {training['perturbation_from']:.0%} of them on"
        text = (
            f"{training['steps']:,} steps of {training['crops']} crops of {training['crop']}², "
            f"{training['optimiser'].capitalize()} at {training['learning_rate']:g}, seed "
            f"{training['seed']}, perceptual term: {record['perceptual']}, perturbation's weight "
            f"{training['perturbation']:g}{begins if training['perturbation'] else ''}"
        )
        names_by_text.setdefault(text, []).append(labels.get(name, name))
    notes = [f"Trained for {text}: {', '.join(names)}." for text, names in names_by_text.items()]
    if diverged:
        notes.append(
            f"**Diverged**, with the same output for every pixel since: {', '.join(diverged)}. Such numbers "
            "do not judge the network's form. Try a lower `learning_rate` or another `seed`."
        )
    return notes
