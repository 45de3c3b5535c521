"""Targets in another folder than the run's are refused, with the one that was meant."""

import pytest
from checkout import ROOT
from shipped import shipped

from neural_shadows.config.reading import read_config
from neural_shadows.config.targets import check_targets
from neural_shadows.errors import InputError


@pytest.mark.parametrize(
    ("scale", "target", "words"),
    [
        ("teapot", "reports/table_4_3.csv", "scale 'teapot'. Use reports/teapot/table_4_3.csv$"),
        ("teapot", "reports/claims.csv", "Use reports/teapot/claims.csv$"),
        ("teapot", "reports/viewer.html", "Use reports/teapot/viewer.html$"),
        ("desk", "reports/mine/table_4_3.csv", "Use reports/table_4_3.csv, or add .* scale=mine"),
        ("desk", "reports/smoke/table_4_3.csv", "Add `--configfile config/smoke.yaml`"),
        ("desk", "table_4_3", "is an entry of `tables`, not a file. Use reports/table_4_3.csv"),
    ],
)
def test_a_wrong_folder(scale, target, words):
    with pytest.raises(InputError, match=words):
        check_targets([target], read_config(shipped(scale=scale)), ROOT / "config")


@pytest.mark.parametrize("scale", ["desk", "teapot"])
def test_a_right_folder_and_others_targets(scale):
    below = "reports" if scale == "desk" else f"reports/{scale}"
    targets = [f"{below}/table_4_3.csv", f"{below}/scenes/dragon.png", "all", "reports/other.csv"]
    check_targets(targets, read_config(shipped(scale=scale)), ROOT / "config")
