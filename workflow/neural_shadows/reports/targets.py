"""What a run makes by default, and its closing words."""

import shutil
from collections.abc import Iterable
from pathlib import Path

from neural_shadows.layout.layout import Layout
from neural_shadows.layout.shown_meshes import shown_meshes
from neural_shadows.reports.drawing import opengl


def all_reports(layout: Layout) -> list[str]:
    """All files of `rule all`."""
    names = [
        *(
            f"{name}{ending}"
            for name in default_tables(layout)
            for ending in (".csv", ".md", ".json")
        ),
        *(f"{name}{ending}" for name in default_figures(layout) for ending in (".png", ".svg")),
        *(f"scenes/{one}{ending}" for one in shown_meshes(layout) for ending in (".png", ".svg")),
        *(f"{name}.html" for name in layout.settings["viewers"]),
        *(f"claims{ending}" for ending in (".csv", ".md", ".json") if layout.settings["claims"]),
        "index.html",
    ]
    return [layout.paths.report(name) for name in names]


def default_tables(layout: Layout) -> list[str]:
    """Names of the tables not on request."""
    entries = layout.settings["tables"].items()
    return [name for name, table in entries if not table["on_request"]]


def default_figures(layout: Layout) -> list[str]:
    """Names of drawable figures of default tables or of no table."""
    shown = [None, *default_tables(layout)]
    drawn = opengl.available()
    return [
        name
        for name, figure in layout.settings["figures"].items()
        if figure.get("table") in shown and (drawn or not figure["needs_opengl"])
    ]


def closing_words(layout: Layout, outputs: Iterable[str]) -> str:
    """Closing text of a run: up to two tables and the files to open."""
    reports = [path for path in outputs if path.startswith(f"{layout.paths.reports}/")]
    written = [path for path in reports if path.endswith(".md")]
    width, lines = shutil.get_terminal_size().columns, []
    for path in written if len(written) <= 2 else ():
        for line in Path(path).read_text(encoding="utf-8").splitlines():
            if line.startswith(("#", "|")):  # not the notes
                lines.append(line if len(line) <= width else f"{line[: width - 1]}…")
    pages = [path for path in reports if path.endswith(".html")]
    whole = [path for path in pages if path.endswith("/index.html")]
    if opened := whole or pages or [path for path in reports if path.endswith((".png", ".md"))]:
        lines.append(f"Open {', '.join(opened)}")
    return "\n".join(lines)
