"""A small report for the tests of its page."""

from pathlib import Path

import numpy as np
from markupsafe import Markup

from neural_shadows.evaluation.first_frames import FirstFrame
from neural_shadows.files.whole_files import write_text
from neural_shadows.reports.figures.loss import loss_figure
from neural_shadows.reports.figures.style import write_strip
from neural_shadows.reports.page import Block, comparison, figure_block, render_page, table_block

TEMPLATES = Path(__file__).parents[1] / "workflow" / "report" / "page"
HOSTILE = "<script>alert('x')</script> & \"quotes\""

TABLE = """# Our method and shadow maps (table 4.3 of the thesis)

| method         |              LPIPS ↓ |   thesis LPIPS |               PSNR ↑ |   thesis PSNR |
|:---------------|---------------------:|---------------:|---------------------:|--------------:|
| 512² shadow map | 0.01 [0.005, 0.02] |         0.0329 | 35.0 [34.0, 36.0] |         32.46 |
| Our <b>method</b> | 0.07 [0.065, 0.08] |         0.0379 | 21.4 [20.0, 22.8] |         27.39 |

- Mean over 24 views; *thesis*: printed.
"""
CLAIMS = """# What the thesis claims

| claim          | verdict          | section   | evidence            |
|:---------------|:-----------------|:----------|:--------------------|
| A beats B.     | **supported**    | 4.3       | A 0.1, B 0.2        |
| B beats C.     | **contradicted** | 4.3       | supported by nobody |

- 1 of 2.
"""


def frames() -> list[FirstFrame]:
    """Two viewpoints by the reference and three methods."""
    rng = np.random.default_rng(1)
    reference = np.full((80, 120), 220, np.uint8)
    reference[20:60, 30:90] = 60
    found = []
    for caption in ("aimed at the cast shadow", "aimed at the surface"):
        frame = FirstFrame(caption, {"reference": reference})
        for i, method in enumerate(("shadow_map_128", "shadow_map_512", "dragon")):
            image = np.roll(reference, 4 - i, axis=1)
            frame.images[method] = image ^ rng.integers(0, 4, image.shape, np.uint8)
            frame.scores[method] = {"psnr": 20.0 + i, "lpips": 0.1}
        found.append(frame)
    return found


def write_page(folder: Path) -> Path:
    """Write a report with one of each part and give its path."""
    import pandas as pd

    for name, text in (("table_4_3.md", TABLE), ("claims.md", CLAIMS)):
        write_text(folder / name, text)
    curve = pd.DataFrame({"step": [1, 2], "samples": [9, 18], "learning_rate": 1, "loss": [2, 1]})
    svg, png = folder / "figure_4_1.svg", folder / "figure_4_1.png"
    write_strip(loss_figure({"a": curve}, title="Loss"), png, svg)
    page = render_page(
        TEMPLATES,
        title=f"Report {HOSTILE}",
        facts=[("scale", "test"), ("mesh of dragon", HOSTILE)],
        claims=table_block(folder / "claims.md"),
        comparisons=[comparison("dragon", f"dragon {HOSTILE}", frames())],
        tables=[table_block(folder / "table_4_3.md")],
        figures=[figure_block(HOSTILE, svg, png)],
        beyond=[Block("fronts", HOSTILE, Markup("<p>Other networks</p>"))],
    )
    write_text(folder / "index.html", page)
    return folder / "index.html"
