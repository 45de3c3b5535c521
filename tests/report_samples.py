"""Rows, metrics and the context of a run, for the tests of reports."""

import inspect
import json
from pathlib import Path

import numpy as np
import pandas as pd
from sample_records import LPIPS, MESH, TRAINING

from neural_shadows.evaluation.method_names import RAY_TRACED, experiment_of, is_shadow_map
from neural_shadows.reports.tables.quality import METRICS

PUBLISHED = Path(__file__).parents[1] / "config" / "published.csv"
RUN = {"scale": "test", "seed": 1, "width": 60, "height": 40, "reference": "exact"}
SCENES = {
    "dragon": {"mesh_name": "wyrm", "procedural": True, "seed": 11},
    "fence": {"mesh_name": "fence", "procedural": True, "seed": 12},
}


def row(method, label=None, *, scene="dragon", published=None, bias=0.0):
    """A row as `config.rows` gives it."""
    network = method != RAY_TRACED and not is_shadow_map(method)
    return {
        "method": method,
        "label": label or method,
        "published": published or method,
        "scene": scene,
        "experiment": experiment_of(method) if network else None,
        "bias": bias if network else None,
    }


def metrics_of(means, views=8):
    """Per-view metrics evenly about the means of {method: {metric: mean}}, in two view sets."""
    spread = np.linspace(-0.1, 0.1, views)
    return pd.DataFrame(
        [
            (i // 2, ("shadow", "surface")[i % 2], method, metric, mean * (1 + spread[i]))
            for i in range(views)
            for method, values in means.items()
            for metric, mean in values.items()
        ],
        columns=["view", "view_set", "method", "metric", "value"],
    )


def all_metrics(mean):
    """The same mean of each metric."""
    return dict.fromkeys(METRICS, mean)


def write_metrics(folder, scene, metrics):
    """Files of per-view metrics as `evaluate` names them, one a method."""
    paths = []
    for method, values in metrics.groupby("method"):
        paths.append(folder / "evaluations" / scene / f"{method}.000.csv")
        paths[-1].parent.mkdir(parents=True, exist_ok=True)
        values.to_csv(paths[-1], index=False)
    return paths


def write_record(path, record):
    """A record as JSON."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(record))
    return path


def write_mesh(folder, scene="dragon", **changes):
    """What `prepare_mesh` writes."""
    record = {**MESH, "name": SCENES[scene]["mesh_name"], "thesis_mesh": False, **changes}
    return write_record(folder / "scenes" / scene / "mesh.json", record)


def write_lpips(folder, available=True):
    """What `find_lpips` writes."""
    return write_record(folder / "lpips.json", {**LPIPS, "available": available})


def written_table(write, folder, **given):
    """The table (CSV as a frame, and the Markdown's path) that a kind's `write` makes.

    What is not given are the files and settings of one scene with one network, `dragon`.
    """
    files = {
        "mesh_json": lambda: write_mesh(folder),
        "meshes": lambda: [write_mesh(folder)],
        "trainings": lambda: [write_record(folder / "networks/dragon/training.json", TRAINING)],
        "lpips_json": lambda: write_lpips(folder),
    }
    settings = {
        "depth_biases": [],
        "weights": [folder / "networks/dragon/weights.safetensors"],
        "published_csv": PUBLISHED,
        "csv": folder / "table.csv",
        "md": folder / "table.md",
        "title": "Title",
        "published": None,
        "run": RUN,
        "scenes": SCENES,
    } | given
    takes = inspect.signature(write).parameters
    write(**{name: settings[name] if name in settings else files[name]() for name in takes})
    return pd.read_csv(folder / "table.csv"), folder / "table.md"


def cells_of(md, line):
    """The cells of a line of a Markdown table (0: its first row) by heading."""
    table = [text for text in md.read_text().splitlines() if text.startswith("|")]
    heads, cells = ([cell.strip() for cell in table[i].split("|")[1:-1]] for i in (0, line + 2))
    return dict(zip(heads, cells, strict=True))
