"""Snakemake's benchmark files: what the runs of a job took."""

from pathlib import Path

import numpy as np

from neural_shadows.errors import InputError
from neural_shadows.files.csv_file import read_csv


def read_seconds(path: Path) -> np.ndarray:
    """Seconds of each run of a job: (runs,).

    Raises:
        InputError: the file is not whole.
    """
    try:
        seconds = read_csv(path, {"s": "float64"}, others=True, separator="\t")["s"].to_numpy()
        if len(seconds) == 0 or not np.isfinite(seconds).all():
            raise ValueError("it has no finite time")
    except (OSError, ValueError) as error:
        # No rule asks for it: it is missed by nobody, and made anew with its job alone.
        raise InputError(f"{path}: no whole benchmark file ({error}); delete it") from error
    return seconds
