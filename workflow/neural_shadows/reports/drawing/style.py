"""Style of all figures: resolution, title, legend, writing."""

import json
import textwrap
from collections.abc import Callable, Iterable
from math import ceil, log10
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

import pandas as pd

from neural_shadows.files.whole_files import whole_file
from neural_shadows.reports.drawing.chart import finish_chart, has_tooltips
from neural_shadows.running.bundles import argument_types, call
from neural_shadows.running.provenance import describe_provenance

if TYPE_CHECKING:
    import matplotlib.axes
    import matplotlib.figure
    from matplotlib.artist import Artist
    from matplotlib.axis import Axis
    from matplotlib.lines import Line2D

# Types of kinds of figures, which the planning of the graph imports without matplotlib.
Figure: TypeAlias = "matplotlib.figure.Figure"
Axes: TypeAlias = "matplotlib.axes.Axes"

DPI = 150
MOST_IN_LINE = 8  # entries of a legend below panels
TITLE_LETTERS, NOTE_LETTERS = 9.5, 12.5  # an inch
MOST_DECADES = 2.2  # of a logarithmic axis with labels between powers of ten
LEAST_LABELS = 3  # of a logarithmic axis
GRID = {"linewidth": 0.4, "alpha": 0.4}


def new_figure(title: str, width: float, height: float) -> Figure:
    """An empty figure with a title, wrapped; sizes in inches."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width, height), dpi=DPI, layout="constrained")
    figure.get_layout_engine().set(h_pad=0.08)  # keeps panels' titles off the figure's
    title = textwrap.fill(title, int(TITLE_LETTERS * width))
    figure.suptitle(title, x=0.01, ha="left", weight="bold")
    return figure


def note_below(figure: Figure, text: str) -> None:
    """Write a note below a figure, each line wrapped."""
    letters = int(NOTE_LETTERS * figure.get_figwidth())
    lines = [textwrap.fill(line, letters) for line in text.splitlines()]
    figure.supxlabel("\n".join(lines), x=0.01, ha="left", fontsize=10)


def plain_numbers(axis: "Axis") -> None:
    """Label a logarithmic axis, with its data, by 0.5, 20, 5k, 2M, 1B."""
    from matplotlib.ticker import LogLocator, MaxNLocator, NullFormatter

    low, high = axis.get_view_interval()
    powers, between = (LogLocator(subs=subs, numticks=12) for subs in ((1,), (1, 2, 5)))
    even = MaxNLocator(LEAST_LABELS + 1, steps=(1, 2, 5, 10))  # less than from 1 to 5
    wide = high > 10**MOST_DECADES * low
    for locator in (powers, between, even) if wide else (between, even):
        places = locator.tick_values(low, high)
        if sum(low <= place <= high for place in places) >= LEAST_LABELS:
            break
    axis.set_major_locator(locator)
    axis.set_major_formatter(lambda number, _: _short(number))
    axis.set_minor_formatter(NullFormatter())


def _short(number: float) -> str:
    size = min(max(int(log10(max(number, 1))) // 3, 0), 3)
    return f"{number / 1000**size:g}{('', 'k', 'M', 'B')[size]}"


def frame_picture(axes: Axes, colour: str = "#bbbbbb", width: float = 0.5) -> None:
    """Replace a picture's axes by a thin frame."""
    axes.set(xticks=[], yticks=[])
    axes.spines[:].set(visible=colour != "none", edgecolor=colour, linewidth=width)


def label_panels(panels: Iterable[tuple[Axes, pd.DataFrame]], size: float, far: int = 0) -> None:
    """Write points' names beside them, when the layout is done.

    Args:
        panels: axes of one figure, and their points: x, y and name, in the order to place them.
        far: see `label_points`.
    """
    from neural_shadows.reports.drawing.point_labels import label_points

    panels = [*panels]
    panels[0][0].get_figure(root=True).draw_without_rendering()
    for axes, points in panels:
        names, places = points.iloc[:, 2], points.iloc[:, :2].to_numpy(float)
        label_points(axes, places, [*names], far=far, fontsize=size)


def legend_below(
    figure: Figure, entries: Iterable["Artist"] = (), columns: int = MOST_IN_LINE
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


def whole_figure(draw: Callable[..., Any]) -> Callable[..., Any]:
    """A function of a figure with `heading`, the title with the scale."""

    def figure(**arguments: Any) -> Any:
        heading = f"{arguments['title']} ({arguments['run']['scale']} scale)"
        return call(draw, {**arguments, "heading": heading})

    figure.__annotations__ = argument_types(draw)
    return figure


def write_figure(drawn: "Figure | tuple[Figure, pd.DataFrame]", png: Path, svg: Path) -> None:
    """Write a figure as PNG and as SVG.

    Each is written whole or not at all, with pictures embedded, and its provenance as a description
    (`provenance_of`). The same figure gives the same bytes: no date, and identifiers from a fixed salt.
    The SVG of a figure with tooltips has them, and its text as text (`finish_chart`).

    Args:
        drawn: a figure, with its values if no table has them (`chart.data_of`).
    """
    from matplotlib import rc_context

    figure, data = drawn if isinstance(drawn, tuple) else (drawn, None)
    chart = data is not None or has_tooltips(figure)
    look = {"svg.hashsalt": "neural_shadows", "svg.fonttype": "none" if chart else "path"}
    made = {"Description": json.dumps(describe_provenance())}
    with rc_context(look):
        for path, metadata in ((png, made), (svg, made | {"Date": None})):
            with whole_file(path) as part:
                figure.savefig(part, metadata=metadata)
    if chart:
        finish_chart(svg, data)


def provenance_of(png: Path) -> dict[str, Any]:
    """The provenance in a figure's PNG; empty without one."""
    from PIL import Image

    if not png.exists():
        return {}
    with Image.open(png) as picture:
        return json.loads(picture.info.get("Description", "{}"))
