"""A user's own frames, made by no scene of ours: from their files to a table, as the graph has it."""

import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from opened import called
from shipped import shipped

from neural_shadows.config.reading import check_files, read_config
from neural_shadows.config.resolved import resolved
from neural_shadows.errors import InputError
from neural_shadows.evaluation.evaluate import evaluate as stage
from neural_shadows.evaluation.measure_frames import measure_frames
from neural_shadows.frames.buffers import CHANNELS
from neural_shadows.layout import evaluations, frame_sets, kinds, tables
from neural_shadows.layout.layout import Layout
from neural_shadows.layout.paths import ALL
from neural_shadows.reports.data.table import whole_table, write_table
from neural_shadows.reports.tables.soft_methods import table as make_table

FRAMES, RADII, HEIGHT, WIDTH = 2, [0.0, 0.5], 12, 16
DARK = 4  # columns, of which a soft light reaches half


@pytest.fixture
def engine(tmp_path, monkeypatch):
    """A folder of frames as an engine would write it, in the working directory."""
    monkeypatch.chdir(tmp_path)
    scene = tmp_path / "mine" / "quay"
    scene.mkdir(parents=True)
    buffers = np.ones((FRAMES, 1, len(CHANNELS), HEIGHT, WIDTH), np.float16)
    buffers[:, 0, CHANNELS.index("hard"), :, :DARK] = 0
    targets = np.ones((FRAMES, len(RADII), HEIGHT, WIDTH), np.float16)
    targets[:, 0, :, :DARK], targets[:, 1, :, :DARK] = 0, 0.5
    arrays = {"buffers": buffers, "targets": targets}
    arrays["valid"] = np.ones((FRAMES, 1, HEIGHT, WIDTH), bool)
    for name, array in arrays.items():
        np.save(scene / f"test_000.{name}.npy", array)
    about = {"frames": [{"twins": []}] * FRAMES, "channels": CHANNELS, "radii": RADII}
    about |= {"size": 40.0, "width": WIDTH, "height": HEIGHT}
    (scene / "test_000.json").write_text(json.dumps(about))
    return scene


@pytest.fixture
def layout(engine):
    table = {"kind": "soft_methods", "title": "Mine", "frame_set": "mine", "methods": ["base_hard"]}
    values = shipped(frame_sets={"mine": {"path": "mine"}}, tables={"soft_mine": table})
    config = read_config(values)
    check_files(config)
    layout = Layout(resolved(config))
    lpips = Path(layout.paths.lpips)
    lpips.parent.mkdir()
    lpips.write_text(json.dumps({"available": False, "reason": "no network"}))
    return layout


def evaluate(layout, method):
    files = {
        ending: layout.paths.evaluation(ending, "mine", method, ALL) for ending in ("csv", "npz")
    }
    Path(files["csv"]).parent.mkdir(parents=True, exist_ok=True)
    job = (layout, "mine", ALL, method)
    called(
        stage,
        input=evaluations.evaluated_files(*job) | {"lpips_json": layout.paths.lpips},
        output={"metrics_csv": files["csv"], "answers_npz": files["npz"]},
        params={"settings": evaluations.evaluated_settings(*job)},
        wildcards={"method": method, "frame_set": "mine", "group": ALL},
    )


def test_a_table(layout):
    for method in tables.methods(layout, "soft_mine"):
        evaluate(layout, method)
    (widths,) = tables.widths(layout, "mine")
    parts = frame_sets.tests(layout, "mine")
    called(
        measure_frames,
        input={"parts": parts, "meshes": []},
        output={"output": widths},
        wildcards={"measure": "widths.json"},
    )
    table = called(
        whole_table(make_table),
        input=kinds.table_files(layout, "soft_mine"),
        params={"settings": kinds.params(layout, "tables", "soft_mine")},
    )
    write_table(table, *(Path(f"mine.{ending}") for ending in ("csv", "md", "json")))
    table = pd.read_csv("mine.csv").set_index(["method", "radius"])
    share = DARK / WIDTH
    assert table["mse"].to_dict() == pytest.approx(
        {
            **{("base_hard", 0.0): 0, ("base_hard", 0.5): share / 4},
            **{("no_shadow", 0.0): share, ("no_shadow", 0.5): share / 4},
            **{("all_dark", 0.0): 1 - share, ("all_dark", 0.5): 1 - share + share / 4},
        }
    )
    assert (table["frames"] == FRAMES).all() and table["ms"].isna().all()
    text = Path("mine.md").read_text(encoding="utf-8")
    assert "| Base: its own hard" in text and "2 frames of 16 × 12 in 1 scenes" in text


def test_nothing_is_written_of_damaged_ones(layout, engine):
    path = engine / "test_000.targets.npy"
    np.save(path, 2 * np.load(path))
    with pytest.raises(InputError, match=r"a target of frame 0 is from 0 to 2"):
        evaluate(layout, "base_hard")
    assert not [*Path("results/evaluations").glob("**/*.*")]
