"""What tables of networks on frames have in common."""

from collections.abc import Mapping

import numpy as np
import pandas as pd

from neural_shadows.evaluation.soft_registry import LABELS, UNLEARNED
from neural_shadows.settings.records import TrainingRecord

ABOUT_NULLS = (
    "The CSV also has rows of what learns nothing (no shadow, all dark, the light's map as it is), "
    "named in `null`: a claim that holds of them as well is vacuous."
)


def nulls_in(found: pd.DataFrame) -> dict[str, str]:
    """What learns nothing and was measured, with its label: rows of a CSV that `null` names."""
    measured = set(found["method"])
    return {method: LABELS[method] for method in UNLEARNED if method in measured}


def learned_rows(table: pd.DataFrame) -> pd.DataFrame:
    """A table without the rows of what learns nothing."""
    return table[table["null"].isna()] if "null" in table else table


def with_printed(
    table: pd.DataFrame, number: str | None, name: str, column: str | None, published: pd.Series
) -> pd.DataFrame:
    """The table with `printed_NAME` and `NAME_minus_printed`; NaN where none is printed.

    Args:
        table: has `row`, the paper's key of each. number: the paper's of the table.
        column: the paper's name of the column; None if the table has a column of such names.
        published: see `read_published_nsm`.
    """
    columns = [column] * len(table) if column else table["column"]
    keys = [(number, *key) for key in zip(table["row"], columns)]
    table = table.assign(**{f"printed_{name}": [published.get(key, np.nan) for key in keys]})
    return table.assign(**{f"{name}_minus_printed": table[name] - table[f"printed_{name}"]})


def describe_trainings(
    records: Mapping[str, TrainingRecord], labels: Mapping[str, str]
) -> list[str]:
    """How networks were trained, those that were trained alike in one sentence; and which died."""
    alike: dict[str, list[str]] = {}
    died = [
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
        alike.setdefault(text, []).append(labels.get(name, name))
    notes = [f"Trained for {text}: {', '.join(names)}." for text, names in alike.items()]
    if died:
        notes.append(
            f"**Died**, and says the same of every pixel since: {', '.join(died)}. Its numbers say "
            "nothing of its form; a lower `learning_rate` or another `seed` may keep it alive."
        )
    return notes
