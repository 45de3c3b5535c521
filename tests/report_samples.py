"""Rows, the context of a run and small results of its stages, for the tests of reports."""

import json
from pathlib import Path

import numpy as np
import pandas as pd

from neural_shadows.reports.data.table import whole_table, write_table
from neural_shadows.reports.drawing.style import whole_figure, write_figure

PUBLISHED = Path(__file__).parents[1] / "config" / "published.csv"
RUN = {"scale": "test", "seed": 1, "width": 60, "height": 40, "reference": "exact"}
SCENES = {
    "dragon": {"mesh_name": "wyrm", "procedural": True, "seed": 11, "least_shadow": 0.0},
    "fence": {"mesh_name": "fence", "procedural": True, "seed": 12, "least_shadow": 0.08},
}
LPIPS = {"net": "alex", "available": True}
MACHINE = {"cpu": "a CPU", "cores": 2, "gpu": None}
ON_CPU = {"device": "cpu", "precision": "float32"}
SETTINGS = {"steps": 10, "batch_size": 64, "learning_rate": 0.1, "schedule": "constant"}
SETTINGS |= {"optimiser": "adam"}
NETWORK = {
    "name": "dragon",
    "died_at_step": None,
    "network": {"encoding": "frequency"},
    "parameters": 100,
    "unfit": False,
}
ORIGIN = {"commit": "ab12", "code": "0f", "machine": MACHINE}
SPENT = {"samples": 640, "seconds": 1.5, **ORIGIN, "threads": 2}
TRAINING = {"training": SETTINGS | ON_CPU} | NETWORK | SPENT
FRAMES = {"width": 60, "height": 40, "views": 4, "repeats": 2, "warm_up": 1, "sphere_rays": 123.0}
TIMES = {"scene": "dragon", "machine": MACHINE} | ON_CPU | FRAMES
# Of methods for soft shadows, of a point and of a light of a quarter of the scene's size.
SOFT_FRAMES = {"width": 8, "height": 4, "radii": [0, 0.5], "given_radii": [0, 0.25]}
SOFT_FRAMES |= {"radius_unit": "scene_sizes"}
SOFT_TIMES = {"frames": 2, "repeats": 3, "once_above_ms": 100, "machine": {"cpu": "a CPU"}}
SOFT_TIMES |= {"maps": {"8": {"ms": 10.0, "texels": 64}}, "share": 1.0}
BY_MAP = {"map": "8", "texel_floats": 1, "held_bytes": 0}
NULL = ("no_shadow", "all_dark")
CLASSIC = ("shadow_map_", "ray_traced", *NULL)


def row(
    method,
    label=None,
    *,
    scene="dragon",
    published=None,
    bias=0.0,
    encoding="frequency",
    trained=True,
):
    """A row as `config.rows` gives it."""
    network = not method.startswith(CLASSIC)
    given = network or method.endswith("_biased")
    return {
        "method": method,
        "label": label or method,
        "published": published or method,
        "scene": scene,
        "experiment": method.removesuffix("_biased") if network else None,
        "encoding": encoding if network else None,
        "trained": network and trained,
        "bias": bias if given else None,
    }


def timed(ms, own_ms=None, device="cpu", resident_bytes=None):
    """The times of a method as `time_methods` gives them."""
    own = own_ms or [one / 2 for one in ms]
    return {"ms": ms, "own_ms": own, "device": device, "resident_bytes": resident_bytes}


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


def write_metrics(folder, means, scene="dragon", views=12):
    """A file of `metrics_of` in the folder of a scene."""
    path = folder / scene / "metrics.csv"
    path.parent.mkdir(parents=True, exist_ok=True)
    columns = {"view": "frame", "view_set": "part"}
    rows = metrics_of(means, views).rename(columns=columns).assign(scene=scene, radius=0)
    rows.to_csv(path, index=False)
    return path


def constants_of(depth_bias, push, at_end):
    """A method's constants as `tune` gives them."""
    chosen = {"depth_bias": depth_bias, "push": push}
    return {"radii": [{"constants": chosen, "at_end": ["depth_bias"] * at_end}]}


def write_record(path, record):
    """A record as JSON."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(record))
    return path


def write_mesh(folder, scene="dragon", **changes):
    """What reports read of what `prepare_mesh` writes."""
    record = {"name": SCENES[scene]["mesh_name"], "faces": 4, "watertight": True}
    return write_record(folder / scene / "mesh.json", {**record, "thesis_mesh": False, **changes})


def written_table(make, folder, **given):
    """The table (CSV as a frame, and the Markdown's path) that a kind's function makes.

    What is not given is of a scene with one network, `dragon`, which has the thesis's bytes.
    """
    weights = folder / "networks" / "dragon" / "weights.safetensors"
    settings = {
        "trainings": [write_record(weights.with_name("training.json"), TRAINING)],
        "lpips_json": write_record(folder / "lpips.json", LPIPS),
        "weights": [weights],
        "published_csv": PUBLISHED,
        "title": "Title",
        "published": None,
        "tables": [],
        "screen_trainings": [],
        "against": None,
        "more_metrics": (),
        "durations": {},
        "run": RUN,
        "scenes": SCENES,
    } | given
    weights.write_bytes(bytes(8 + 2_227_200))  # the length of an empty header, and the weights
    return written(whole_table(make)(**settings), folder)


def written_figure(draw, folder, **given):
    """The SVG's text of the figure that a kind's function draws; the PNG is beside it."""
    png, svg = folder / "figure.png", folder / "figure.svg"
    write_figure(whole_figure(draw)(**{"title": "Title", "run": RUN, **given}), png, svg)
    return svg.read_text(encoding="utf-8")


def written(table, folder):
    """The CSV of a table as a frame, and the path of its Markdown."""
    csv, md, json = (folder / f"table.{ending}" for ending in ("csv", "md", "json"))
    write_table(table, csv, md, json)
    return pd.read_csv(csv), md


def cells_of(md, line):
    """The cells of a line of a Markdown table (0: its first row) by heading."""
    table = [text for text in md.read_text().splitlines() if text.startswith("|")]
    heads, cells = ([cell.strip() for cell in table[i].split("|")[1:-1]] for i in (0, line + 2))
    return dict(zip(heads, cells, strict=True))
