"""The page's tables and figures as HTML."""

import base64
import io
import itertools
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from markdown_it import MarkdownIt
from markupsafe import Markup
from PIL import Image

from neural_shadows.reports.verdicts import VERDICTS, css_class

LARGEST_SVG = 300_000  # bytes; a larger one is shown as pixels


@dataclass(frozen=True)
class Block:
    """A table or figure of the page.

    `title` is its line in the contents; a `caption` is shown below a figure, `notes` below a table.
    """

    kind: str
    name: str
    title: str
    html: Markup
    caption: str = ""
    notes: tuple[Markup, ...] = ()

    @property
    def anchor(self) -> str:
        """Unlike those of other kinds and of the page's sections, whatever the name."""
        return f"{self.kind}-{self.name}"


def table_block(path: Path) -> Block:
    """A Markdown twin as HTML; the thesis's columns and verdicts get classes of their own.

    What stands before the table stays there, outside its scrolled box; evidence is folded up.
    """
    markdown = MarkdownIt("commonmark", {"html": False}).enable("table")
    tokens = markdown.parse(path.read_text(encoding="utf-8"))
    title, kinds = tokens[1].content, [token.type for token in tokens]
    start, end = kinds.index("table_open"), kinds.index("table_close") + 1
    pairs = zip(tokens[:end], tokens[1:])
    cells = [(cell, text.content) for cell, text in pairs if cell.type in ("th_open", "td_open")]
    headings = [text for cell, text in cells if cell.type == "th_open"]
    for (cell, text), heading in zip(cells, itertools.cycle(headings)):
        if heading.startswith("thesis"):
            cell.attrSet("class", "thesis")
        elif heading == "evidence" and cell.type == "td_open":
            cell.attrSet("class", "evidence")
        elif text.strip("*") in VERDICTS:
            cell.attrSet("class", css_class(text.strip("*")))
    lead = Markup(markdown.renderer.render(tokens[3:start], markdown.options, {}))
    html = markdown.renderer.render(tokens[start:end], markdown.options, {})
    html = re.sub(r'(<td[^>]* class="evidence">)(.*?)</td>', _folded, html)
    # An interval stands below its value, so that twelve columns fit on a screen.
    html = re.sub(r"(<td[^>]*>[^<\[]+) (\[[^<\]]+\])</td>", r"\1 <small>\2</small></td>", html)
    # It scrolls: Chromium lets the keyboard reach it by itself, Safari needs the tabindex.
    box = Markup('<div class="scroll" role="region" tabindex="0" aria-label="{}">').format(title)
    notes = tuple(
        Markup(markdown.renderer.render([token], markdown.options, {}))
        for token in tokens[end:]
        if token.type == "inline"
    )
    return Block("table", path.stem, title, Markup(f"{lead}{box}{html}</div>"), notes=notes)


def _folded(cell: re.Match) -> str:
    """A cell's list, parted by semicolons, that opens when asked for."""
    items = cell[2].split("; ")
    listed = "".join(f"<li>{item}</li>" for item in items)
    return f"{cell[1]}<details><summary>{len(items)}</summary><ul>{listed}</ul></details></td>"


def figure_blocks(paths: Sequence[Path], titles: Mapping[str, str]) -> list[Block]:
    """Figures as images: the SVG if it is small, or else the PNG as WebP, half its size.

    Their titles, given by name, stand in the pictures. `figure_4_3` is figure 4.3 of the thesis.
    """
    blocks = []
    for svg in dict.fromkeys(path.with_suffix(".svg") for path in paths):
        if svg in paths and svg.stat().st_size <= LARGEST_SVG:
            source = data_uri("svg+xml", svg.read_bytes())
        else:
            with Image.open(svg.with_suffix(".png")) as image:
                source = webp_uri(image)
        name = svg.stem
        title, caption = titles.get(name, name), ""
        html = Markup('<img alt="{}" src="{}">').format(title, source)
        if number := re.fullmatch(r"figure_(\d)_(\d+)", name):
            caption = f"Figure {number[1]}.{number[2]}"
            title = f"{caption}: {title}"
        blocks.append(Block("figure", name, title, html, caption))
    return blocks


def data_uri(kind: str, content: bytes) -> str:
    """An image within the page: its bytes, of `svg+xml`, `webp`, …"""
    return f"data:image/{kind};base64,{base64.b64encode(content).decode()}"


def webp_uri(image: Image.Image) -> str:
    """An image as lossless WebP within the page."""
    file = io.BytesIO()
    # Effort, not loss: 100 takes 1.3 s for a frame of 600 × 400 and 75 0.25 s, for 3 % more bytes.
    image.save(file, "WEBP", lossless=True, quality=75, method=6)
    return data_uri("webp", file.getvalue())
