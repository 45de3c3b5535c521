"""How trained networks compare with what takes as many bytes, in sentences made from a table."""

import numpy as np
import pandas as pd
from markupsafe import Markup

from neural_shadows.reports.finding_words import (
    ALIKE,
    bytes_beside,
    error_beside,
    in_memory,
    name_of,
    size_of,
    with_psnr,
    worth_of,
)
from neural_shadows.reports.tables.quality import with_ends

SAME_GRID = 1.05  # times the parameters: the same grid


def best_of_their_size(table: pd.DataFrame) -> list[Markup]:
    """How the best trained network compares with what is of another kind and takes no more bytes.

    Before it, where that one does not win, the largest network that does.
    """
    known = table.dropna(subset=["psnr_pooled", "stored_bytes"])
    networks = known[known["samples"].gt(0) & ~failed(known)]
    if networks.empty:
        return []
    best = best_of(networks)
    said = [of_its_size(known, best)]
    for _, other in networks.sort_values("stored_bytes")[::-1].iterrows():
        rival = _rival(known, other, "stored_bytes")
        first = best_of(known[known["stored_bytes"] <= ALIKE * other["stored_bytes"]])
        wins = rival is not None and _compared(other, rival)[1] > 0
        wins = wins and other["psnr_pooled"] > _with_bytes(known, rival, other["stored_bytes"])
        if wins and first["method"] == other["method"]:
            return said if other["method"] == best["method"] else [of_its_size(known, other), *said]
    return said


def of_its_size(known: pd.DataFrame, best: pd.Series) -> Markup:
    """How a trained network compares with what is of another kind and takes no more bytes.

    In a file, and then in memory, where another rival may be the strongest.

    Args:
        known: the methods of a scene whose quality and bytes are known.
    """
    size = Markup("<strong>{}</strong>").format(size_of(best["stored_bytes"]))
    worth = worth_of(best, "map_psnr")
    other, held = (_rival(known, best, kept) for kept in ("stored_bytes", "resident_bytes"))
    memory = Markup()
    if held is not None and (other is None or held["method"] != other["method"]):
        memory = in_memory(best, other, held, *_compared(best, held))
    if other is None:
        said = Markup("The best trained network is the {}, in {}{}.{}")
        return said.format(with_psnr(best), size, worth, memory)
    difference, side = _compared(best, other)
    if side > 0:
        said = (
            "In {size} nothing measured comes closer to the exact shadow than the {best}{worth}. The "
            "best of another kind, the {other} in {bytes}, {error}.{memory}"
        )
    elif side < 0:
        said = (
            "The best trained network, the {best} in {size}, loses to the {other}, which takes "
            "{bytes} and {error}.{memory}"
        )
    else:
        said = "In {size} the {best} and the {other} are too close to tell which is better.{memory}"
    return Markup(said).format(
        size=size,
        best=with_psnr(best),
        other=with_psnr(other),
        worth=worth,
        bytes=bytes_beside(best["stored_bytes"], other["stored_bytes"]),
        memory=memory,
        error=error_beside(difference),
    )


def training_adds(table: pd.DataFrame) -> Markup | None:
    """What training adds over the same grid with nothing trained in it."""
    fields = table[table["encoding"].eq("occupancy_field")].dropna(subset=["psnr_pooled"])
    built = fields[fields["samples"].eq(0)]
    for _, trained in fields[fields["samples"].gt(0)].sort_values("psnr_pooled")[::-1].iterrows():
        ratio = built["parameters"] / trained["parameters"]
        same = built[ratio.between(1 / SAME_GRID, SAME_GRID)]
        if len(same):
            break
    else:
        return None
    other = best_of(same)
    difference, side = _compared(trained, other)
    said = {
        1: "Training pays: the {} is {} better than the same grid untrained ({}).",
        -1: "Training does not pay: the {} is {} worse than the same grid untrained ({}).",
        0: "Whether training pays is not clear: the {} is {} from the same grid untrained ({}), "
        "within what chance does.",
    }
    decibels = Markup("<strong>{:.1f} dB</strong>").format(abs(difference))
    return Markup(said[side]).format(name_of(trained), decibels, name_of(other))


def best_of(rows: pd.DataFrame) -> pd.Series:
    """The row of the best pooled PSNR."""
    return rows.loc[rows["psnr_pooled"].idxmax()]


def failed(rows: pd.DataFrame) -> pd.Series:
    """Which are said not to have learned; of too few views nothing is said."""
    return rows["learned"].astype(str).eq("False")


def _rival(known: pd.DataFrame, best: pd.Series, column: str) -> pd.Series | None:
    """The best of another kind that has no more bytes than `best` in a column; None for none."""
    alike = known["encoding"].eq(best["encoding"]) & known["samples"].gt(0)
    fits = known[~alike & (known[column] <= ALIKE * best[column])]
    return None if fits.empty else best_of(fits)


def _with_bytes(known: pd.DataFrame, rival: pd.Series, stored: float) -> float:
    """The pooled PSNR of a rival's kind with as many bytes, between the sizes that were measured.

    A decimated mesh of 159 KiB has 37.1 dB beside a field of 177 KiB with 37.6; of 177 KiB, 37.7.
    Of a coded rival between coded sizes, of another between others.
    """
    kind = known[known["encoding"].eq(rival["encoding"]) & known["samples"].eq(0)]
    if "coded" in known:
        kind = kind[kind["coded"].astype(str).eq(str(rival["coded"]))]
    if len(kind) < 2:
        return rival["psnr_pooled"]
    kind = kind.sort_values("stored_bytes")
    return float(np.interp(np.log(stored), np.log(kind["stored_bytes"]), kind["psnr_pooled"]))


def _compared(a: pd.Series, b: pd.Series) -> tuple[float, int]:
    """By how many dB `a` is better than `b`, and whether it is (1), is worse (-1) or neither (0).

    By the paired difference, if the table has theirs, or else where intervals are apart: those of
    both's paired differences to a third, or of their values.
    """
    for one, other, sign in ((a, b, 1), (b, a, -1)):
        # The row that the others' differences are to has none itself.
        if pd.isna(other.get("psnr_difference")) and pd.notna(one.get("psnr_difference")):
            value, *ends = sign * one[with_ends("psnr_difference")].astype(float)
            break
    else:
        value = a["psnr_pooled"] - b["psnr_pooled"]
        of = "psnr_difference" if _paired(a) and _paired(b) else "psnr_pooled"
        ends = [a[f"{of}_low"] - b[f"{of}_high"], a[f"{of}_high"] - b[f"{of}_low"]]
    return value, int(min(ends) > 0) - int(max(ends) < 0)


def _paired(row: pd.Series) -> bool:
    return pd.notna(row.get("psnr_difference_low"))
