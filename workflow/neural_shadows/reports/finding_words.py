"""Words that findings are made of: sizes, errors, maps and methods with their numbers."""

import pandas as pd
from markupsafe import Markup

from neural_shadows.reports.digits import short
from neural_shadows.reports.tables.quality import with_ends

ALIKE = 1.02  # times the bytes: as many
CLEAR = 1.2  # times the error: less is told in dB


def size_of(stored: float) -> str:
    """Bytes as KiB or MiB, three digits."""
    return (
        f"{short(stored / 2**20)} MiB" if stored >= 1000 * 2**10 else f"{short(stored / 2**10)} KiB"
    )


def on_scene(scene: str, sentence: Markup) -> Markup:
    """A sentence of one scene, where there are several."""
    return Markup("On the {}, ").format(scene) + sentence[0].lower() + sentence[1:]


def error_beside(decibels: float, its: str = "its") -> str:
    """How the error of what is worse by `decibels` compares, or better where they are negative.

    Args:
        its: whose error it is compared with.
    """
    factor = 10 ** (abs(decibels) / 10)
    if factor < CLEAR:
        return f"is {abs(decibels):.2g} dB {'worse' if decibels > 0 else 'better'}"
    times = f"{factor:.0f}" if factor >= 10 else f"{factor:.2g}"
    return f"has {times} times {its if decibels > 0 else 'less'} squared error"


def bytes_beside(stored: float, other: float) -> str:
    """What another stores, which is no more than `ALIKE` times as many bytes."""
    return "as many bytes" if other * ALIKE >= stored else size_of(other)


def in_memory(
    best: pd.Series, filed: pd.Series | None, held: pd.Series, difference: float, side: int
) -> Markup:
    """A sentence on the strongest rival that takes no more memory.

    Args:
        filed, held: the strongest rivals by the bytes of a file and by those in memory.
        difference, side: by how many dB `best` is better than `held`, and whether that is clear.
    """
    taken = Markup(" In memory the {} takes {}")
    why = Markup()
    if filed is not None:
        tree = " with its tree of boxes" if filed["encoding"] == "mesh" else ""
        why = Markup(", the {} {}{}").format(name_of(filed), size_of(filed["resident_bytes"]), tree)
    told = error_beside(difference, "the network's") if side else "is too close to tell apart"
    said = taken + why + "; the best of another kind that takes no more is the {}, which {}."
    return said.format(name_of(best), size_of(best["resident_bytes"]), with_psnr(held), told)


def name_of(row: pd.Series) -> Markup:
    """A method's name."""
    return Markup("<strong>{}</strong>").format(row["method"])


def with_psnr(row: pd.Series) -> Markup:
    """A method's name and its pooled PSNR with the interval."""
    value, low, high = row[with_ends("psnr_pooled")]
    interval = f" [{low:.1f}, {high:.1f}]" if pd.notna(low) else ""
    return Markup("{} ({:.1f} dB{})").format(name_of(row), value, interval)


def worth_of(row: pd.Series, column: str) -> Markup:
    """Which shadow map is as good, and what that would store."""
    if not isinstance(row[column], str):
        return Markup()
    stored = size_of(4 * float(row[column].lstrip("<> ")) ** 2)
    return Markup(", worth {} of {}").format(map_of(row[column]), stored)


def map_of(size: str) -> Markup:
    """A size of `equivalent_maps` in words: `386`, `< 128`, `> 2048`."""
    than = {"<": "less than ", ">": "more than "}.get(size[0], "")
    return Markup("{}a <strong>{}²</strong> shadow map").format(than, size.lstrip("<> "))
