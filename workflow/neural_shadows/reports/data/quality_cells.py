"""The Markdown's cells of quality, and what their columns mean."""

from dataclasses import replace

import pandas as pd

from neural_shadows.reports.data.quality import with_ends
from neural_shadows.reports.data.table import Column, intervals

# Markdown: heading, factor, decimals. The thesis prints LPIPS and SSIM with four, PSNR with two.
READING = {
    "lpips": ("LPIPS ↓", 1, 4),
    "psnr": ("PSNR ↑", 1, 2),
    "psnr_pooled": ("pooled PSNR ↑", 1, 2),
    "ssim": ("SSIM ↑", 1, 4),
    "flip": ("FLIP ↓", 1, 4),
    "shadow_error": ("shadow error % ↓", 100, 2),
    "false_shadow": ("false shadow % ↓", 100, 2),
    "light_leak": ("light leak % ↓", 100, 2),
}


def describe_quality(table: pd.DataFrame, against: str | None) -> list[str]:
    """Sentences on the columns of `scene_quality`; `against`: the label of the other method."""
    most = table["identical"].max()
    notes = [
        "pooled PSNR: of the mean squared error of all views, which identical frames (100 dB by "
        "agreement) do not drive as they do the mean; "
        + (f"a method has up to {most:.0f} of them." if most else "there are none here."),
        *describe_learned(table),
        *describe_unfit(table),
    ]
    if table["map_psnr"].fillna("").any():
        notes.append(
            "equal map: texels along a side of the shadow map that would be as good, by LPIPS / by "
            "pooled PSNR; –: not measured."
        )
    if against:
        notes.append(f"difference: of pooled PSNR, from {against}, on the same views.")
    return notes


def describe_learned(table: pd.DataFrame) -> list[str]:
    """One sentence on what it is not to have learned, if a network has not."""
    if not table["learned"].eq(False).any():
        return []
    return [
        "**not learned**: not better than drawing no shadow at all, in LPIPS (without it FLIP), "
        "pooled PSNR and SSIM, by the interval of paired differences and the thesis's own "
        "difference from run to run."
    ]


def describe_unfit(table: pd.DataFrame) -> list[str]:
    """One sentence on what it is to be unfit, if a network is."""
    if not table["unfit"].eq(True).any():
        return []
    return [
        "**unfit**: it needs an inside, which this open and thin mesh does not have; leave out its "
        "`start` and `surface`, and it is trained as a sheet."
    ]


def method_column(table: pd.DataFrame) -> Column:
    """The names of methods, of a network with whether it is unfit or has learned nothing."""
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
    """A metric: mean [low, high]. LPIPS is not comparable with the thesis's, of another network."""
    _, factor, decimals = READING[metric]
    column = intervals(table, with_ends(metric), decimals, factor)
    return replace(column, comparable=metric != "lpips")
