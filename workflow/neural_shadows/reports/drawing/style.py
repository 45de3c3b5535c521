"""Style of all figures: resolution, title, legend, writing."""

from collections.abc import Iterable
from math import ceil
from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd

from neural_shadows.files.whole_files import whole_file

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

DPI = 150
MOST_IN_LINE = 8  # entries of a legend below panels
GRID = {"linewidth": 0.4, "alpha": 0.4}


def new_figure(title: str, width: float, height: float) -> "Figure":
    """An empty figure with a title; sizes in inches."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width, height), dpi=DPI, layout="constrained")
    figure.get_layout_engine().set(h_pad=0.08)  # keeps panels' titles off the figure's
    figure.suptitle(title, x=0.01, ha="left", weight="bold")
    return figure


def note_below(figure: "Figure", text: str) -> None:
    """Write a note below a figure."""
    figure.supxlabel(text, x=0.01, ha="left", fontsize=10)


def plain_numbers(axis: "Axis") -> None:
    """Label a logarithmic axis with plain numbers such as 0.5."""
    from matplotlib.ticker import LogLocator, NullFormatter

    axis.set_major_locator(LogLocator(subs=(1, 2, 5)))  # less than a decade: no power of ten
    axis.set_major_formatter("{x:g}")
    axis.set_minor_formatter(NullFormatter())


def legend_below(
    figure: "Figure", entries: Iterable["Artist"] = (), columns: int = MOST_IN_LINE
) -> None:
    """Draw one legend of all panels' labels and entries below."""
    labelled = [handle for axes in figure.axes for handle in axes.get_legend_handles_labels()[0]]
    handles = {artist.get_label(): artist for artist in (*labelled, *entries)}
    columns = ceil(len(handles) / ceil(len(handles) / columns))
    figure.legend(handles=[*handles.values()], loc="outside lower center", ncols=columns)


def hollow(table: pd.DataFrame) -> list["Line2D"]:
    """The legend's entry for unlearned rows, hollow, if any."""
    from matplotlib.lines import Line2D

    look = {"color": "#555555", "marker": "o", "linestyle": "", "markerfacecolor": "none"}
    any_hollow = table["learned"].eq("False").any()
    return [Line2D([], [], label="not learned", **look)] if any_hollow else []


def write_figure(figure: "Figure", png: Path, svg: Path) -> None:
    """Write a figure as PNG and as SVG.

    Each is written whole or not at all, with pictures embedded. The same figure gives the same
    bytes: no date, and identifiers from a fixed salt.
    """
    from matplotlib import rc_context

    with rc_context({"svg.hashsalt": "neural_shadows"}):
        for path, metadata in ((png, None), (svg, {"Date": None})):
            with whole_file(path) as part:
                figure.savefig(part, metadata=metadata)
