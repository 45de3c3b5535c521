"""Blocks of the page: tables and figures with anchors and embedded files."""

import base64
import io
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from urllib.parse import quote

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
    return {path.name: csv_uri(path.read_text(encoding="utf-8"))} if path.exists() else {}


def csv_uri(text: str) -> str:
    """A CSV within the page: as letters, three quarters of the bytes of base64."""
    return f"data:text/csv;charset=utf-8,{quote(text, safe=',;:()/+')}"


def data_uri(kind: str, content: bytes) -> str:
    """A file within the page: its bytes, of `image/webp`, `image/avif`, …"""
    return f"data:{kind};base64,{base64.b64encode(content).decode()}"


def pictures_once(data: Any) -> tuple[Any, list[str]]:
    """Data for the page's script with `{"picture": number}` in each picture's place, and the pictures.

    Tables of soft shadows share frames and methods: 300 KB of the default run's 4 MB stood twice or more.
    """
    numbers: dict[str, int] = {}

    def numbered(value: Any) -> Any:
        match value:
            case dict():
                return {key: numbered(one) for key, one in value.items()}
            case list():
                return [numbered(one) for one in value]
            case str() if value.startswith("data:"):
                return {"picture": numbers.setdefault(value, len(numbers))}
        return value

    return numbered(data), [*numbers]


def lossless_uri(image: Image.Image) -> str:
    """A picture within the page, as WebP."""
    file = io.BytesIO()
    # 75 is effort: 100 takes 1.3 s for a frame of 600 × 400 and 75 0.25 s, for 3 % more bytes.
    image.save(file, "WEBP", lossless=True, quality=75, method=6)
    return data_uri("image/webp", file.getvalue())


def lossy_uri(image: Image.Image, quality: int) -> str:
    """A picture within the page, as AVIF.

    Figures of quality 40 take half the bytes of WebP of quality 75, which has fringes at letters.
    """
    file = io.BytesIO()
    image.save(file, "AVIF", quality=quality, speed=8)  # 6 takes three times as long, for 5 %
    return data_uri("image/avif", file.getvalue())
