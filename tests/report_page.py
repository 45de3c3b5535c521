"""A small page for the tests of the report's page."""

from pathlib import Path

import numpy as np
import report_samples as samples
from PIL import Image

from neural_shadows.evaluation.first_frames import write_first_frames
from neural_shadows.reports.page import write_page

TEMPLATE = sorted((Path(__file__).parents[1] / "workflow" / "report" / "page").iterdir())
HOSTILE = "<script>alert('x')</script> & \"quotes\""
SHARED = "A note to several tables."
TABLE = f"""# Networks and shadow maps (table 4.3 of the thesis)

| method           |            LPIPS ↓ |   thesis LPIPS | verdict       |
|:-----------------|-------------------:|---------------:|:--------------|
| 512² shadow map  | 0.01 [0.005, 0.02] |         0.0329 | **supported** |
| A <b>network</b> | 0.07 [0.065, 0.08] |         0.0379 | by nobody     |

- Mean over 24 views; *thesis*: printed.
- {SHARED}
"""
LABELS = {"shadow_map_128": "128² map", "shadow_map_512": "512² map", "dragon": "Network"}


def write_frames(folder: Path) -> tuple[list[Path], Path]:
    """Pictures of two viewpoints by the reference and three methods, and the methods' metrics."""
    reference = np.full((80, 120), 0.8)
    reference[20:60, 30:90] = 0.2
    means = {method: {"psnr": 20 + i, "lpips": 0.1} for i, method in enumerate(LABELS)}
    metrics = samples.write_metrics(folder, means, views=2)
    pictures = [metrics.with_name(f"{method}.npz") for method in ("reference", *LABELS)]
    for shift, path in enumerate(pictures):
        image = np.roll(reference, shift, axis=1)
        write_first_frames(path, path.stem, {"shadow": image[:, ::-1], "surface": image})
    return pictures, metrics


def make_page(folder: Path, **changes) -> Path:
    """Write a page with one of each part, or with those that `changes` leave, and give its path."""
    tables = [folder / f"{name}.md" for name in ("table_4_3", "tables", "beyond", "claims")]
    for path in tables:
        path.write_text(TABLE)
    figure = folder / "figure_4_1.png"
    Image.new("RGB", (9, 9)).save(figure)
    pictures, metrics = write_frames(folder)
    parts = {
        "html": folder / "index.html",
        "template": TEMPLATE,
        "tables": tables[:3],
        "figures": [figure],
        "claims_md": tables[3],
        "pictures": pictures,
        "metrics": [metrics],
        "meshes": [samples.write_mesh(folder, name=HOSTILE)],
        "trainings": [samples.write_record(folder / "training.json", samples.TRAINING)],
        "lpips_json": samples.write_record(folder / "lpips.json", samples.LPIPS),
        "titles": {"figure_4_1": HOSTILE},
        "beyond": ["beyond"],
        "rows": [samples.row(method, label) for method, label in LABELS.items()],
        "run": {**samples.RUN, "scale": HOSTILE},
        "scenes": samples.SCENES,
        "benchmarks": folder / "none",
    }
    write_page(**parts | changes)
    return folder / "index.html"
