"""A small page for the tests of the report's page."""

from pathlib import Path

import numpy as np
import pandas as pd
from report_samples import (
    RUN,
    SCENES,
    metrics_of,
    row,
    write_lpips,
    write_mesh,
    write_metrics,
    write_record,
)
from sample_records import TRAINING

from neural_shadows.evaluation.first_frames import write_first_frames
from neural_shadows.files.whole_files import write_text
from neural_shadows.reports.figures.loss import loss_figure
from neural_shadows.reports.figures.style import write_figure
from neural_shadows.reports.page import write_page

TEMPLATE = sorted((Path(__file__).parents[1] / "workflow" / "report" / "page").iterdir())
HOSTILE = "<script>alert('x')</script> & \"quotes\""
SHARED = "A note to several tables."

TABLE = f"""# Networks and shadow maps (table 4.3 of the thesis)

| method         |              LPIPS ↓ |   thesis LPIPS |               PSNR ↑ |   thesis PSNR |
|:---------------|---------------------:|---------------:|---------------------:|--------------:|
| 512² shadow map | 0.01 [0.005, 0.02] |         0.0329 | 35.0 [34.0, 36.0] |         32.46 |
| A <b>network</b> | 0.07 [0.065, 0.08] |         0.0379 | 21.4 [20.0, 22.8] |         27.39 |

- Mean over 24 views; *thesis*: printed.
- {SHARED}
"""
CLAIMS = f"""# What the thesis claims

| claim          | verdict          | section   | evidence            |
|:---------------|:-----------------|:----------|:--------------------|
| A beats B.     | **supported**    | 4.3       | A 0.1, B 0.2        |
| B beats C.     | **contradicted** | 4.3       | supported by nobody |

- 1 of 2.
- {SHARED}
"""
METHODS = ("shadow_map_128", "shadow_map_512", "dragon")
LABELS = ("128² shadow map", "512² shadow map", "Thesis's network")


def write_frames(folder: Path) -> list[Path]:
    """Pictures of two viewpoints by the reference and three methods."""
    rng = np.random.default_rng(1)
    reference = np.full((80, 120), 220, np.uint8)
    reference[20:60, 30:90] = 60
    images = {"reference": reference}
    for i, method in enumerate(METHODS):
        image = np.roll(reference, 4 - i, axis=1)
        images[method] = image ^ rng.integers(0, 4, image.shape, np.uint8)
    paths = []
    for method, image in images.items():
        path = folder / "pictures" / "dragon" / f"{method}.000.npz"
        path.parent.mkdir(parents=True, exist_ok=True)
        write_first_frames(path, method, {"shadow": image[:, ::-1] / 255, "surface": image / 255})
        paths.append(path)
    return paths


def make_page(folder: Path, **changes) -> Path:
    """Write a page with one of each part, or with those that `changes` leave, and give its path.

    The page has tables of the names of its sections.
    """
    names = ("table_4_3", "claims", "tables", "beyond")
    for name in names:
        write_text(folder / f"{name}.md", CLAIMS if name == "claims" else TABLE)
    curve = pd.DataFrame({"step": [1, 2], "samples": [9, 18], "learning_rate": 1, "loss": [2, 1]})
    figure = [folder / "figure_4_1.svg", folder / "figure_4_1.png"]
    write_figure(loss_figure({"a": curve}, title="Loss"), figure[1], figure[0])
    scores = {method: {"psnr": 20.0 + i, "lpips": 0.1} for i, method in enumerate(METHODS)}
    parts = {
        "html": folder / "index.html",
        "template": TEMPLATE,
        "tables": [folder / f"{name}.md" for name in ("table_4_3", "tables", "beyond")],
        "figures": figure,
        "claims_md": folder / "claims.md",
        "pictures": write_frames(folder),
        "metrics": write_metrics(folder, "dragon", metrics_of(scores, views=2)),
        "meshes": [write_mesh(folder, name=HOSTILE)],
        "trainings": [write_record(folder / "training.json", TRAINING)],
        "lpips_json": write_lpips(folder),
        "titles": {"figure_4_1": HOSTILE},
        "beyond": ["beyond"],
        "rows": [row(method, label) for method, label in zip(METHODS, LABELS)],
        "run": {**RUN, "scale": HOSTILE},
        "scenes": SCENES,
        "benchmarks": folder / "benchmarks",
    }
    write_page(**parts | changes)
    return folder / "index.html"
