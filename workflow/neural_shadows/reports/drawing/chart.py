"""Charts: figures whose text stays text, and whose points say their values under the pointer."""

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any
from xml.etree import ElementTree

import pandas as pd

from neural_shadows.files.whole_files import whole_file
from neural_shadows.reports.drawing.style import write_figure

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SVG = "http://www.w3.org/2000/svg"
DATA = "data"
SAYS = "says "  # an SVG's identifier that is what a point says begins so
REACH = "9"  # points about a marker's middle in which it is pointed at


def say(artist: "Artist", text: str) -> None:
    """Let what is drawn say a text when it is pointed at."""
    artist.set_gid(SAYS + text)


def saying_points(
    axes: "Axes", x: Iterable[float], y: Iterable[float], texts: Iterable[str], **look: Any
) -> None:
    """Draw points that each say a text."""
    for *place, text in zip(x, y, texts):
        (point,) = axes.plot(
            *([value] for value in place), **{"linestyle": "", "marker": "o"} | look
        )
        say(point, text)


def write_chart(figure: "Figure", png: Path, svg: Path, data: pd.DataFrame | None = None) -> None:
    """`write_figure`, with `<title>` elements in the SVG that browsers show at the points.

    `data` is what no table shows: the SVG holds it as CSV (`data_of`).
    """
    from matplotlib import rc_context

    with rc_context({"svg.fonttype": "none"}):
        write_figure(figure, png, svg)
    for prefix, address in (("", SVG), ("xlink", "http://www.w3.org/1999/xlink")):
        ElementTree.register_namespace(prefix, address)
    tree = ElementTree.parse(svg)
    for group in [*tree.iter(f"{{{SVG}}}g")]:
        if group.get("id", "").startswith(SAYS):
            title = ElementTree.Element("title")
            title.text = group.attrib.pop("id").removeprefix(SAYS)
            group.set("class", "says")
            group.insert(0, title)
            for mark in [*group.iter(f"{{{SVG}}}use")]:
                place = {"cx": mark.get("x"), "cy": mark.get("y"), "r": REACH, "fill": "none"}
                group.append(ElementTree.Element("circle", {**place, "pointer-events": "all"}))
    if data is not None:
        held = ElementTree.SubElement(tree.getroot(), "metadata", {"id": DATA})
        held.text = data.to_csv(index=False, float_format="%.6g")
    with whole_file(svg) as part:
        tree.write(part, encoding="utf-8", xml_declaration=True)


def data_of(svg: bytes) -> str:
    """The CSV that a chart's SVG holds; empty if it holds none."""
    held = ElementTree.fromstring(svg).find(f"{{{SVG}}}metadata[@id='{DATA}']")
    return "" if held is None else held.text
