"""Figures of the page, in its light and dark colours."""

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from xml.etree import ElementTree

from markupsafe import Markup
from PIL import Image

from neural_shadows.reports.drawing.chart import data_of
from neural_shadows.reports.drawing.style import provenance_of
from neural_shadows.reports.page.blocks import Block, csv_uri, lossy_uri, made_line

LARGEST_SVG = 300_000  # bytes; a larger one is shown as pixels
WIDEST, QUALITY = 1152, 36  # of these; the page is 1,008 wide
SVG = "{http://www.w3.org/2000/svg}"
XLINK = "{http://www.w3.org/1999/xlink}"

# The colours of figures that change with the page's.
THEMED = {
    "#ffffff": "var(--paper)",
    "#000000": "var(--ink)",
    **dict.fromkeys(("#555555", "#666666", "#777777"), "var(--soft)"),
    **dict.fromkeys(("#b0b0b0", "#bbbbbb", "#cccccc"), "var(--line)"),
}


def figure_blocks(
    paths: Sequence[Path], titles: Mapping[str, str], tables: Mapping[str, Block]
) -> list[Block]:
    """Figures: an SVG as it is; a large one, or one with pictures in it, as pixels.

    `figure_4_3` is figure 4.3 of the thesis.

    Args:
        paths: `.svg` and `.png` of each figure, in order; titles: by name.
        tables: the page's tables that figures show, by the figures' names.
    """
    return [
        _block(svg, svg in paths, titles.get(svg.stem, svg.stem), tables.get(svg.stem))
        for svg in dict.fromkeys(path.with_suffix(".svg") for path in paths)
    ]


def _block(svg: Path, drawn: bool, title: str, table: Block | None) -> Block:
    # A CSV is on the page once: one of 50 KB was, with its figures, in 12 places.
    caption, files = "", {"its table": f"#{table.anchor}"} if table else {}
    if number := re.fullmatch(r"figure_(\d)_(\d+)", svg.stem):
        caption = f"Figure {number[1]}.{number[2]}"
    if drawn and svg.stat().st_size <= LARGEST_SVG and b"<image" not in svg.read_bytes():
        html = inline_svg(svg.read_bytes(), svg.stem, title)
        if data := data_of(svg.read_bytes()):
            files = {f"{svg.stem}.csv": csv_uri(data)}
    else:
        with Image.open(svg.with_suffix(".png")) as image:
            picture = image.convert("RGB")
        picture.thumbnail((WIDEST, picture.height))
        html = Markup('<img alt="{}" src="{}">').format(title, lossy_uri(picture, QUALITY))
    title = f"{caption}: {title}" if caption else title
    made = made_line(provenance_of(svg.with_suffix(".png")))
    return Block("figure", svg.stem, title, html, caption, files=files, made=made)


def inline_svg(content: bytes, name: str, title: str) -> Markup:
    """Inline a matplotlib SVG with unique identifiers and no styles.

    Args:
        name: prefix of its identifiers.
    """
    root = ElementTree.fromstring(content)
    for parent in [*root.iter()]:
        for child in [*parent]:
            if child.tag.endswith(("}metadata", "}style")):
                parent.remove(child)
            child.tail = _said(child.tail)
    width, height = (float(size) for size in root.get("viewBox").split()[2:])
    root.attrib = {
        "viewBox": root.get("viewBox"),
        "class": "chart",
        "role": "img",
        "aria-label": title,
        # Its letters are of 8 points and more: a narrower screen scrolls it.
        "style": f"min-width: {width:.0f}px; aspect-ratio: {width:g} / {height:g}",
    }
    if any(element.get("class") == "says" for element in root.iter()):
        root.set("tabindex", "0")  # for the arrow keys
    for element in root.iter():
        element.tag = element.tag.removeprefix(SVG)
        element.text = _said(element.text)
        if "id" in element.attrib and element.tag not in ("clipPath", "path", "marker"):
            del element.attrib["id"]  # of a group: nothing refers to it
        for key, value in [*element.attrib.items()]:
            del element.attrib[key]
            element.set(key.removeprefix(XLINK), _renamed(key, value, name))
    _dissolve_groups(root)
    return Markup(ElementTree.tostring(root, encoding="unicode"))


def _dissolve_groups(element: ElementTree.Element) -> None:
    """Put the children of groups that say nothing in their places: three stood around each tick."""
    for child in element:
        _dissolve_groups(child)
    children = [*element]
    for child in children:
        element.remove(child)
        plain = child.tag == "g" and not child.attrib
        element.extend([*child] if plain else [child])


def _said(text: str | None) -> str | None:
    """A text, without that which only indents."""
    return text if (text or "").strip() else None


def _renamed(key: str, value: str, name: str) -> str:
    if key == "id":
        return f"{name}-{value}"
    if key.endswith("href"):
        return value.replace("#", f"#{name}-")
    value = " ".join(value.replace("url(#", f"url(#{name}-").split())
    value = re.sub(r" font-family: [^;]*;?", "", value)  # the style sheet's
    value = re.sub(r"-?\d+\.\d{3,}", lambda match: f"{float(match[0]):.2f}", value)
    return re.sub(r"#[0-9a-f]{6}\b", lambda match: themed(match[0]), value)


def themed(colour: str) -> str:
    """Replace black, white and greys by the page's colours."""
    return THEMED.get(colour, colour)
