"""What all figures share: colours, resolution, writing."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from neural_shadows.files.whole_files import whole_file

if TYPE_CHECKING:
    from matplotlib.figure import Figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

DPI = 150


def write_strip(figure: Figure, png_path: str | Path, svg_path: str | Path) -> None:
    """Write a figure as PNG and as SVG (pictures embedded), each whole or not at all.

    The same figure gives the same bytes: no date, and identifiers from a fixed salt.
    """
    from matplotlib import rc_context

    with rc_context({"svg.hashsalt": "neural_shadows"}):
        for path in (png_path, svg_path):
            with whole_file(path) as part:
                metadata = {"Date": None} if part.suffix == ".svg" else None
                figure.savefig(part, metadata=metadata)


# Okabe and Ito's colours, which readers with any colour vision tell apart.
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000")
