"""What all figures share: colours, resolution, title, legend, writing."""

from collections.abc import Iterable, Mapping
from math import ceil
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pandas as pd

from neural_shadows.files.whole_files import whole_file

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

Section = Mapping[str, Any]  # of the configuration, or of what it says of a run
DPI = 150
MOST_IN_LINE = 8  # entries of a legend below panels
GRID = {"linewidth": 0.4, "alpha": 0.4}


def new_figure(title: str, width: float, height: float) -> "Figure":
    """An empty figure of so many inches under its title."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width, height), dpi=DPI, layout="constrained")
    figure.get_layout_engine().set(h_pad=0.08)  # keeps panels' titles off the figure's
    figure.suptitle(title, x=0.01, ha="left", weight="bold")
    return figure


def note_below(figure: "Figure", text: str) -> None:
    """What a reader must know to read the figure, in lines below it."""
    figure.supxlabel(text, x=0.01, ha="left", fontsize=10)


def plain_numbers(axis: "Axis") -> None:
    """Label a logarithmic axis with 0.5 and 20: less than a decade has no power of ten."""
    from matplotlib.ticker import LogLocator, NullFormatter

    axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    axis.set_major_formatter("{x:g}")
    axis.set_minor_formatter(NullFormatter())


def legend_below(
    figure: "Figure", entries: Iterable["Artist"] = (), most: int = MOST_IN_LINE
) -> None:
    """One legend for all panels, in lines below them: what is labelled in them, and entries."""
    labelled = [handle for axes in figure.axes for handle in axes.get_legend_handles_labels()[0]]
    handles = {artist.get_label(): artist for artist in (*labelled, *entries)}
    columns = ceil(len(handles) / ceil(len(handles) / most))
    figure.legend(handles=[*handles.values()], loc="outside lower center", ncols=columns)


def hollow(table: pd.DataFrame) -> list["Line2D"]:
    """The legend's entry of hollow markers, if a row of a table's CSV has not `learned`."""
    from matplotlib.lines import Line2D

    look = {"color": "#555555", "marker": "o", "linestyle": "", "markerfacecolor": "none"}
    some = table["learned"].eq("False").any()
    return [Line2D([], [], label="not learned", **look)] if some else []


def write_figure(figure: "Figure", png: Path, svg: Path) -> None:
    """Write a figure as PNG and as SVG (pictures embedded), each whole or not at all.

    The same figure gives the same bytes: no date, and identifiers from a fixed salt.
    """
    from matplotlib import rc_context

    with rc_context({"svg.hashsalt": "neural_shadows"}):
        for path, metadata in ((png, None), (svg, {"Date": None})):
            with whole_file(path) as part:
                figure.savefig(part, metadata=metadata)
