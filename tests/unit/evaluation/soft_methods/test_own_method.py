"""The recipes for methods in config/README.md: one file for soft shadows, one for hard ones."""

import os
import subprocess
import sys

from checkout import Checkout

SOFT = '''
"""A share of each cosine with the light."""

from neural_shadows.evaluation.look import PINK, Look
from neural_shadows.evaluation.soft_method import SoftMethod

LOOK = Look("own method", PINK, "d", "⬧", "A share of each cosine.")


def _visibility(frame, radius, *, share):
    return share * frame.cosines.astype("f4")


METHODS = {"mine_1": SoftMethod(_visibility, {"share": (0.25, 0.5)}, "Mine", of_radius=False)}
'''
HARD = '''
"""Shadow in layers of points."""

from neural_shadows.evaluation.hard_method import HardMethod, whatever_bias
from neural_shadows.evaluation.look import PINK, Look

LOOK = Look("own method", PINK, "d", "⬧", "Shadow in layers.")


def _of_scene(scene, layers, whole_map):
    return lambda frame: whatever_bias(frame.visibility((frame.p[:, 1] * layers % 2).round()))


METHODS = {"mine": HardMethod("{} layers", LOOK, _of_scene, range(1, 9), lambda layers: 4 * layers)}
'''
# In a process of its own, whose modules are those of the copy.
FOLLOWED = """
import pandas as pd
import neural_shadows.reports.answers.answer_frames
import neural_shadows.reports.tables.soft_methods
from shipped import shipped
from neural_shadows.config.reading import read_config
from neural_shadows.config.resolved import resolved
from neural_shadows.evaluation.memory import stored_bytes
from neural_shadows.evaluation.method_names import hard_modules
from neural_shadows.evaluation.soft_registry import look_of, method_module, soft_method
from neural_shadows.layout import kinds, soft_methods
from neural_shadows.layout.layout import Layout
from neural_shadows.reports.data import method_look
from neural_shadows.reports.drawing.shown_errors import COLUMNS
from neural_shadows.reports.figures.soft_equal_time import equal_time_figure
from neural_shadows.reports.page import page

soft = {"kind": "soft_methods", "title": "Mine", "frame_set": "frames", "methods": ["mine_1", "hard"]}
hard = {"title": "Mine", "scene": "dragon", "rows": ["mine_3", {"method": "mine_4", "bias": "held_out"}]}
layout = Layout(resolved(read_config(shipped(tables={"few": soft, "hard": hard}))), ".")
assert soft_methods.labels(layout, "few")["mine_1"] == "Mine"
assert soft_methods.weights(layout, "mine_1") == []
assert method_module("mine_1").name == "mine.py" and soft_method("mine_1").constants
assert method_module("mine_1") in kinds.method_modules(layout, "tables", "few")
row = {"method": "mine_1", "label": "Mine", "number": 0, "radius": 0.1, "unit": "m", "ms": 1.0}
row |= dict.fromkeys(COLUMNS, 0.1)
figure = equal_time_figure(pd.DataFrame([row]), [0], title="Title")
assert [text.get_text() for text in figure.legends[0].get_texts()] == ["own method"]

first, second, *_ = layout.entry("tables", "hard")["rows"]
assert (first["label"], second["label"]) == ("3 layers", "4 layers, with bias")
assert method_look.look_of(second).name == "own method" and stored_bytes("mine_3") == 12
(module,) = hard_modules(["mine_3"])
assert module.parent.name == "hard_methods"
assert module in kinds.method_modules(layout, "tables", "hard")
"""


def test_the_recipes_give_methods_that_every_report_can_show(tmp_path):
    checkout = Checkout.fresh(tmp_path)
    checkout.module("evaluation/soft_methods/mine.py").write_text(SOFT)
    checkout.module("evaluation/hard_methods/mine.py").write_text(HARD)
    folders = [tmp_path / "workflow", tmp_path / "tests"]
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(map(str, folders))}
    done = subprocess.run(
        [sys.executable, "-c", FOLLOWED],
        env=environment,
        cwd=tmp_path,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
