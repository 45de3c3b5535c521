"""Blocks of the page: tables and figures with anchors and embedded files."""

import base64
import io
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from markdown_it import MarkdownIt
from markupsafe import Markup
from PIL import Image

from neural_shadows.running.provenance import provenance_line

MARKDOWN = MarkdownIt("commonmark", {"html": False})


@dataclass(frozen=True)
class Block:
    """A table or figure of the page.

    Args:
        title: its line in the contents.
        html: a figure; caption: below it.
        parts: of a table, one for each scene (`table_blocks.Part`).
        notes: below a table; the first says how to read it.
        files: its downloads: addresses within the page, by file name.
        made: its provenance, a line.
    """

    kind: str
    name: str
    title: str
    html: Markup = Markup()
    caption: str = ""
    parts: Sequence[Any] = ()
    notes: tuple[Markup, ...] = ()
    files: Mapping[str, str] = field(default_factory=dict)
    made: Markup = Markup()

    @property
    def anchor(self) -> str:
        """Unique anchor on the page."""
        return f"{self.kind}-{self.name}"


def inline(text: str) -> Markup:
    """A line of Markdown as HTML."""
    return Markup(MARKDOWN.renderInline(text))


def made_line(provenance: Mapping[str, Any]) -> Markup:
    """The line of a provenance; empty of an older report without one."""
    return inline(provenance_line(provenance)) if provenance else Markup()


def csv_file(path: Path) -> dict[str, str]:
    """A CSV as a file of a block; nothing without the file."""
    return {path.name: data_uri("text/csv", path.read_bytes())} if path.exists() else {}


def data_uri(kind: str, content: bytes) -> str:
    """A file within the page: its bytes, of `image/webp`, `text/csv`, …"""
    return f"data:{kind};base64,{base64.b64encode(content).decode()}"


def webp_uri(image: Image.Image, lossless: bool = True) -> str:
    """An image as WebP within the page: a frame lossless, since its pixels are compared."""
    file = io.BytesIO()
    # Lossless it is effort: 100 takes 1.3 s for a frame of 600 × 400 and 75 0.25 s, for 3 % more
    # bytes. A strip of pictures has 476 KB lossless and half of that of quality 75.
    image.save(file, "WEBP", lossless=lossless, quality=75, method=6)
    return data_uri("image/webp", file.getvalue())
