"""A small page for the tests of the report's page."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import report_samples as samples
from frame_samples import write_frames
from matplotlib.figure import Figure
from PIL import Image

from neural_shadows.reports.data.table import Table, intervals, numbers, write_table
from neural_shadows.reports.drawing.chart import add_tooltip
from neural_shadows.reports.drawing.style import write_figure
from neural_shadows.reports.page.page import write_page

TEMPLATE = sorted((Path(__file__).parents[1] / "workflow" / "report" / "page").iterdir())
HOSTILE = "<script>alert('x')</script> & \"quotes\""
SHARED = "A note to several tables."
CLAIMS = (
    "claim,text,kind,number_of,number,section,statement,verdict,reason,evidence,samples,text_samples\n"
    f'less,thesis,better,,,4.3,"{HOSTILE.replace(chr(34), chr(34) * 2)}",supported,all,"PSNR of A 3 against B 2: +1 [+0.5, +2]",10,1000\n'
    'more,thesis,better,,,4.3,More is more.,undecided (scale),1 seed,"loss of A 3 against B 2: +1; too few",10,1000\n'
)
VIEWER = """<!DOCTYPE html><title>Viewer</title><p id="said">waits</p>
<script>document.getElementById("said").textContent = "runs" + ("</scr" + "ipt>").length;
addEventListener("message", ({ data }) => { document.getElementById("said").textContent = data.open; });
parent.postMessage({ viewer: "left=map_64" }, "*");</script>"""
POINTS = "second", "third"
LABELS = {"shadow_map_128": "128² map", "shadow_map_512": "512² map", "dragon": "Network"}


def table() -> Table:
    """Two methods beside printed numbers."""
    frame = pd.DataFrame({"value": [0.01, 0.07], "low": [0.005, 0.065], "high": [0.02, 0.08]})
    columns = {
        "method": ["512² shadow map", "A <b>network</b>"],
        "LPIPS ↓": replace(intervals(frame, [*frame], 3), comparable=False),
        "thesis LPIPS": numbers([0.0329, 0.0379], "{:.4f}", printed_of="LPIPS ↓"),
        "verdict": ["**supported**", "by nobody"],
    }
    notes = ["Mean over 24 views; *thesis*: printed.", SHARED]
    data = pd.DataFrame({"a": [1]})
    return Table(data, columns, notes, title="Networks and shadow maps (table 4.3 of the thesis)")


def seen_frames() -> dict[str, dict[tuple[str, int], np.ndarray]]:
    """The visibility (80, 120) of two viewpoints by the reference and three methods."""
    reference = np.ones((80, 120))
    reference[20:60, 30:90] = 0
    seen = {}
    for shift, method in enumerate(("reference", *LABELS)):
        lit = np.roll(reference, shift, axis=1)
        seen[method] = {("shadow", 0): lit[:, ::-1], ("surface", 0): lit}
    return seen


def write_evaluated(folder: Path) -> dict[str, list[Path]]:
    """These frames and metrics of them."""
    means = {m: {"psnr": 20 + i, "lpips": 0.1, "flip": 0.2} for i, m in enumerate(LABELS)}
    metrics = samples.write_metrics(folder, means, views=2)
    references, visibilities = write_frames(metrics.parent, seen_frames())
    return {"references": references, "visibilities": visibilities, "metrics": [metrics]}


def make_page(folder: Path, **changes) -> Path:
    """Write a page with one of each part, or with those that `changes` leave, and give its path."""
    tables = [folder / f"{name}.json" for name in ("table_4_3", "tables", "beyond", "claims")]
    for path in tables:
        named = replace(table(), title=f"{table().title}, {path.stem}")  # each its own
        write_table(named, path.with_suffix(".csv"), path.with_suffix(".md"), path)
        path.with_suffix(".csv").write_text(CLAIMS if path.stem == "claims" else "method,a\nb,1\n")
    figure = folder / "figure_4_1.png"
    Image.new("RGB", (9, 9)).save(figure)
    drawing = folder / "figure_front.svg"
    chart = Figure(figsize=(5, 3))
    axes = chart.subplots()
    for x, text in enumerate((HOSTILE, *POINTS)):
        (point,) = axes.plot([x], [2], "o")
        add_tooltip(point, text)
    write_figure(chart, drawing.with_suffix(".png"), drawing)
    viewer = folder / "viewer.html"
    viewer.write_text(VIEWER)
    Image.new("RGB", (96, 64), "green").save(viewer.with_suffix(".png"))
    soft_viewer = folder / "viewer_soft.html"
    soft_viewer.write_text("<title>Soft shadows: room &amp; dragon</title>")
    parts = {
        "html": folder / "index.html",
        "template": TEMPLATE,
        "tables": tables[:3],
        "figures": [figure, drawing],
        "viewers": [viewer, soft_viewer],
        "soft_viewers": ["viewer_soft"],
        "claims_json": tables[3],
        **write_evaluated(folder),
        "meshes": [samples.write_mesh(folder, name=HOSTILE)],
        "trainings": [samples.write_record(folder / "training.json", samples.TRAINING)],
        "lpips_json": samples.write_record(folder / "lpips.json", samples.LPIPS),
        "titles": {"figure_4_1": HOSTILE},
        "data": {"figure_front": "beyond"},
        "chapters": {
            **dict.fromkeys(("table_4_3", "tables", "figure_4_1", "figure_front"), "thesis"),
            "beyond": "extensions",
        },
        "questions": [
            {"claim": "less", "question": "Is less more?", "figure": "figure_4_1"},
            {"claim": "unjudged", "question": "Is nothing?", "figure": ""},
        ],
        "networks": [],
        "soft_parts": [],
        "soft_answers": [],
        "soft_pictures": [],
        "folded": ["figure_4_1"],
        "missing": [],
        "rows": [samples.row(method, label) for method, label in LABELS.items()],
        "kinds": {"512² shadow map": "map", "Network": "frequency"},
        "run": {**samples.RUN, "scale": HOSTILE},
        "scenes": samples.SCENES,
        "benchmarks": folder / "none",
    }
    write_page(**parts | changes)
    return folder / "index.html"
