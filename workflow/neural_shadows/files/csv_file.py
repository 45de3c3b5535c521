"""CSV files, checked for being whole."""

import io
from collections.abc import Mapping
from pathlib import Path

import pandas as pd

# A table has some forty; pandas takes minutes to name a hundred thousand.
_MOST_COLUMNS = 1000


def read_csv(
    path: str | Path, kinds: Mapping[str, str], *, others: bool = False, separator: str = ","
) -> pd.DataFrame:
    """Read a CSV file with a header, whose every line ends with a line break.

    Args:
        kinds: pandas' type by column, in the file's order.
        others: whether these are some of the file's columns, in any order, or all.

    Raises:
        ValueError: the reason why it is no whole file of this kind, to follow its name.
        OSError: it cannot be read.
    """
    content = Path(path).read_bytes()
    names = content.partition(b"\n")[0].decode("utf-8", "replace").rstrip("\r").split(separator)
    if len(names) > _MOST_COLUMNS or len(set(names)) < len(names):
        raise ValueError(f"it has {len(names):,} columns, {len(set(names)):,} different ones")
    if missing := [column for column in kinds if column not in names]:
        raise ValueError(f"it has no column {missing[0]}")
    if not others and names != list(kinds):
        raise ValueError(f"its columns are not {separator.join(kinds)}")
    # A number cut in two is still a number: only the missing line break tells.
    if not content.endswith(b"\n"):
        raise ValueError("it is cut short")
    try:
        return pd.read_csv(io.BytesIO(content), dtype=dict(kinds), sep=separator)
    except (ValueError, OverflowError) as error:  # pandas ends some messages with a line break
        raise ValueError(" ".join(str(error).split())[:200]) from error
