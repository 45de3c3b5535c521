"""The errors in figures of soft shadows."""

import pandas as pd

from neural_shadows.reports.data.frame_means import OFF_EDGES

PARTS = ("", "_low", "_high")
COLUMNS = tuple(f"{error}{part}" for error in ("mse", OFF_EDGES) for part in PARTS)


def with_shown_errors(table: pd.DataFrame) -> tuple[pd.DataFrame, str]:
    """Add errors off edges if measured, else of all pixels.

    Args:
        table: with `COLUMNS`; of a user's own frames, without geometry, all off edges are NaN.

    Returns: the table with `error`, `error_low` and `error_high`, and their name.
    """
    off_edges = table[OFF_EDGES].notna().any()
    shown = {f"error{part}": table[f"{OFF_EDGES if off_edges else 'mse'}{part}"] for part in PARTS}
    return table.assign(**shown), "MSE off edges" if off_edges else "MSE"
