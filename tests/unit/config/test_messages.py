"""Each kind of mistake is reported in one line with its key, its value and what is allowed."""

import pytest

from neural_shadows.config.base import not_among
from neural_shadows.config.reading import read_config
from neural_shadows.errors import InputError

MISTAKES = [
    ("sceens", {}, "unknown key: 'sceens' (did you mean 'scenes'?) is not among scale, seed"),
    ("rendering.widht", 3, "rendering: unknown key: 'widht' (did you mean 'width'?)"),
    ("rendering.width", "600", "rendering.width = '600': Input should be a valid integer"),
    ("rendering.width", True, "rendering.width = True: Input should be a valid integer"),
    ("rendering.width", 3, "rendering.width = 3: Input should be greater than or equal to 64"),
    ("rendering.width", None, "rendering.width: this key is missing"),
    ("rendering", 3, "rendering: should be a section of keys, not 3"),
    ("tables.table_4_3.rows.0", 3, "tables.table_4_3.rows.0: should be a section of keys, not 3"),
    ("tables.table_4_3.rows", [], "tables.table_4_3.rows = []: List should have at least 1 item"),
    ("scenes.My", {"mesh": {"path": "x.ply"}}, "scenes.My = 'My': String should match pattern"),
    (
        "networks.256",
        {"encoding": "occupancy_field"},
        "networks.256 = 256: Input should be a valid string",
    ),
    ("networks.thesis.encoding", "wavelet", "`encoding` should be one of frequency, ray_grid"),
    ("networks.thesis.width", 7, "networks.thesis.width = 7: Input should be greater"),
    ("networks.field_128.resolution", 66, "resolution = 66: must be a multiple of 4"),
    ("experiments.dragon_hash_grid.network.table_size", 1000, "table_size = 1000: must be a power"),
    ("samplings.uniform.min_quad", 256, "samplings.uniform: min_quad = 256: must not exceed"),
    ("samplings.uniform.shards", 2001, "shards = 2001: must not exceed directions (2000)"),
    ("trainings.base.learning_rate", "1e-3", "= '1e-3': is text to YAML; write a number with a"),
    ("trainings.base.learning_rate", float("nan"), "learning_rate = nan: Input should be a finite"),
    ("compute", {"device": "gpu"}, "compute.device = 'gpu': Input should be 'auto', 'cpu' or"),
    ("metrics.lpips.net", "resnet", "metrics.lpips.net = 'resnet': Input should be 'alex'"),
    ("scale", "networks", "scale = 'networks': is the name of a folder of results"),
]


@pytest.mark.parametrize(("key", "value", "words"), MISTAKES, ids=lambda part: str(part)[:40])
def test_mistakes(message, key, value, words):
    assert words in message(key, value)


def test_long_lists_are_cut():
    assert (
        not_among("x", map(str, range(30)))
        == f"'x' is not among {', '.join(map(str, range(20)))}, …"
    )


def test_several_mistakes_are_counted(values):
    values["rendering"] |= {"width": 3, "height": 3}
    with pytest.raises(InputError, match=r"rendering\.width = 3: .* \(and 1 more\)$"):
        read_config(values)
