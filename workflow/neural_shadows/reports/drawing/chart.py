"""Charts with text as text, and tooltips at their points."""

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any
from xml.etree import ElementTree

import pandas as pd

from neural_shadows.files.whole_files import whole_file

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SVG = "http://www.w3.org/2000/svg"
DATA = "data"
TOOLTIP = "says "  # prefix of SVG identifiers that hold a tooltip
REACH = "9"  # radius in points about a marker's middle that shows its tooltip


def add_tooltip(artist: "Artist", text: str) -> None:
    """Show a text under the pointer on an artist."""
    artist.set_gid(TOOLTIP + text)


def points_with_tooltips(
    axes: "Axes", x: Iterable[float], y: Iterable[float], texts: Iterable[str], **look: Any
) -> None:
    """Draw points with a tooltip each."""
    look = {"linestyle": "", "marker": "o"} | look
    for point_x, point_y, text in zip(x, y, texts):
        (point,) = axes.plot([point_x], [point_y], **look)
        add_tooltip(point, text)


def point_with_interval(
    axes: "Axes", x: float, value: float, ends: Sequence[float], text: str, **look: Any
) -> None:
    """Draw a point with its interval and a tooltip."""
    spread = [[value - ends[0]], [ends[1] - value]]
    bar = axes.errorbar(x, value, spread, **{"capsize": 2, "linestyle": ""} | look)
    add_tooltip(bar.lines[0], text)


def has_tooltips(figure: "Figure") -> bool:
    """Check for an artist with a tooltip."""
    return bool(figure.findobj(lambda artist: (artist.get_gid() or "").startswith(TOOLTIP)))


def finish_chart(svg: Path, data: pd.DataFrame | None) -> None:
    """Put tooltips into a figure's SVG.

    These are `<title>` elements, shown by browsers at the points.

    Args:
        data: values without a table, held as CSV in the SVG (`data_of`).
    """
    for prefix, address in (("", SVG), ("xlink", "http://www.w3.org/1999/xlink")):
        ElementTree.register_namespace(prefix, address)
    tree = ElementTree.parse(svg)
    for group in [*tree.iter(f"{{{SVG}}}g")]:
        if group.get("id", "").startswith(TOOLTIP):
            title = ElementTree.Element("title")
            title.text = group.attrib.pop("id").removeprefix(TOOLTIP)
            group.set("class", "says")
            group.insert(0, title)
            for mark in [*group.iter(f"{{{SVG}}}use")]:
                circle = {"cx": mark.get("x"), "cy": mark.get("y"), "r": REACH, "fill": "none"}
                group.append(ElementTree.Element("circle", {**circle, "pointer-events": "all"}))
    if data is not None:
        metadata = ElementTree.SubElement(tree.getroot(), "metadata", {"id": DATA})
        metadata.text = data.to_csv(index=False, float_format="%.6g")
    with whole_file(svg) as part:
        tree.write(part, encoding="utf-8", xml_declaration=True)


def data_of(svg: bytes) -> str:
    """The CSV in a chart's SVG; empty without one."""
    metadata = ElementTree.fromstring(svg).find(f"{{{SVG}}}metadata[@id='{DATA}']")
    return "" if metadata is None else metadata.text
