"""Cells and notes of quality columns."""

from dataclasses import replace

import pandas as pd

from neural_shadows.metrics.registry import metrics
from neural_shadows.reports.data.table import Column, intervals, numbers, with_ends


def describe_quality(table: pd.DataFrame, against: str | None) -> list[str]:
    """Describe the columns of `scene_quality`; `against`: the other method's label."""
    most = table["identical"].max()
    notes = [
        "pooled PSNR: of the mean squared error of all views; identical frames (100 dB by "
        "convention) do not dominate it as they do the mean; "
        + (f"a method has up to {most:.0f} of them." if most else "there are none here."),
        *describe_learned(table),
        *describe_unfit(table),
    ]
    if table["map_psnr"].fillna("").any():
        notes.append(
            "equal map: texels along a side of the equally good shadow map, by LPIPS / by "
            "pooled PSNR; –: not measured."
        )
    if against:
        notes.append(f"difference: of pooled PSNR, from {against}, on the same views.")
    return notes


def describe_learned(table: pd.DataFrame) -> list[str]:
    """Explain `not learned`; nothing without such networks."""
    if not table["learned"].eq(False).any():
        return []
    return [
        "**not learned**: not better than drawing no shadow at all, in LPIPS (without it FLIP), "
        "pooled PSNR and SSIM, by the interval of paired differences and the thesis's own "
        "difference from run to run."
    ]


def describe_unfit(table: pd.DataFrame) -> list[str]:
    """Explain `unfit`; nothing without such networks."""
    if not table["unfit"].eq(True).any():
        return []
    return [
        "**unfit**: it needs an inside, and this open, thin mesh has none. Leave out its "
        "`start` and `surface` to train it as a sheet."
    ]


def method_column(table: pd.DataFrame) -> Column:
    """Names of methods, marked if unfit or not learned."""
    marks = pd.Series("", table.index)
    marks[table["learned"].eq(False)] = " (**not learned**)"
    if "unfit" in table:
        marks[table["unfit"].eq(True)] = " (**unfit**)"
    return Column([*table["method"] + marks], labels=[*table["method"]])


def difference_column(table: pd.DataFrame) -> Column:
    """The difference of pooled PSNRs, with its sign."""
    return intervals(table, with_ends("psnr_difference"), 2, sign="+")


def map_cells(lpips: pd.Series, psnr: pd.Series) -> list[str]:
    """The texts of `equivalent_maps`: by LPIPS / by PSNR, – for one that is missing."""
    pairs = zip(lpips.fillna(""), psnr.fillna(""))
    return [
        " / ".join(f"{size}²" if size else "–" for size in pair) if any(pair) else ""
        for pair in pairs
    ]


def quality_column(table: pd.DataFrame, metric: str) -> Column:
    """A metric of hard shadows: mean [low, high]."""
    column = metric_column(table, metric, interval=True)
    return replace(column, comparable=metrics()[metric].comparable)


def metric_column(
    table: pd.DataFrame,
    metric: str,
    name: str | None = None,
    *,
    interval: bool = False,
    digits: int | None = None,
    sign: str = "",
) -> Column:
    """A metric in its unit, with its digits or others.

    Args:
        name: of the table's column, if another than the metric's.
        interval: with its ends, see `with_ends`, and `sign`, see `intervals`.
    """
    described, name = metrics()[metric], name or metric
    digits = described.digits if digits is None else digits
    if interval:
        return intervals(table, with_ends(name), digits, described.factor, sign)
    return numbers(table[name], f"{{:.{digits}f}}", described.factor)
