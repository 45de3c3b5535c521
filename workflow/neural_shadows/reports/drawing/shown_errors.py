"""Which error figures of soft shadows show: off the geometry's edges, where that is at hand."""

import pandas as pd

from neural_shadows.reports.data.frame_means import OFF_EDGES

PARTS = ("", "_low", "_high")
COLUMNS = tuple(f"{error}{part}" for error in ("mse", OFF_EDGES) for part in PARTS)


def with_shown_errors(table: pd.DataFrame) -> tuple[pd.DataFrame, str]:
    """A table with `error`, `error_low` and `error_high`, and what they are called.

    Args:
        table: with `COLUMNS`; off edges all are NaN of a user's own frames, whose geometry is not at
            hand.
    """
    known = table[OFF_EDGES].notna().any()
    shown = {f"error{part}": table[f"{OFF_EDGES if known else 'mse'}{part}"] for part in PARTS}
    return table.assign(**shown), "MSE off edges" if known else "MSE"
