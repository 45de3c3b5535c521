"""The recipe for a soft-shadow method in config/README.md: a file, and a line of its label."""

import os
import subprocess
import sys

from checkout import Checkout

MINE = '''
"""Half of what a shadow map shows."""

from neural_shadows.evaluation.soft_methods.soft_method import SoftMethod


def _answer(frame, radius, share):
    return share * frame.cosines.astype("f4")


METHODS = {"mine_1": SoftMethod(_answer, {"share": (0.25, 0.5)}, of_radius=False)}
'''
# In a process of its own, whose modules are those of the copy.
FOLLOWED = """
import pandas as pd
import neural_shadows.reports.answer_frames
import neural_shadows.reports.page
import neural_shadows.reports.tables.soft_methods
from shipped import shipped
from neural_shadows.config.reading import read_config
from neural_shadows.config.resolved import resolved
from neural_shadows.evaluation.soft_methods.registry import method_module, soft_method
from neural_shadows.layout import soft_methods
from neural_shadows.layout.layout import Layout
from neural_shadows.reports.figures.soft_equal_time import equal_time_figure
from neural_shadows.reports.soft_looks import SOFT_METHODS

table = {"kind": "soft_methods", "title": "Mine", "frame_set": "frames", "methods": ["mine_1", "hard"]}
layout = Layout(resolved(read_config(shipped(tables={"few": table}))), ".")
assert soft_methods.labels(layout, "few")["mine_1"] == "Mine"
assert soft_methods.weights(layout, "mine_1") == []
assert method_module("mine_1").name == "mine.py" and soft_method("mine_1").constants
assert SOFT_METHODS["Mine"].name == "other methods"
row = {"method": "mine_1", "label": "Mine", "number": 0, "radius": 0.1, "unit": "m", "ms": 1.0}
row |= {"mse": 0.1, "mse_low": 0.05, "mse_high": 0.2}
figure = equal_time_figure(pd.DataFrame([row]), [0], title="Title")
assert [text.get_text() for text in figure.legends[0].get_texts()] == ["other methods"]
"""


def test_the_recipe_gives_a_method_that_every_report_can_show(tmp_path):
    checkout = Checkout.fresh(tmp_path)
    checkout.module("evaluation/soft_methods/mine.py").write_text(MINE)
    names = checkout.module("evaluation/soft_method_names.py")
    labels = names.read_text(encoding="utf-8")
    with_mine = labels.replace(
        '    "pcss": "PCSS",\n', '    "pcss": "PCSS",\n    "mine_1": "Mine",\n'
    )
    assert with_mine != labels
    names.write_text(with_mine, encoding="utf-8")
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
