"""Records are what their writers write, and whatever else lies there is named and moved aside."""

import json
from pathlib import Path

import pytest
import trimesh
from sample_records import COST

from neural_shadows.errors import InputError
from neural_shadows.files import records
from neural_shadows.meshes.prepare_mesh import prepare_mesh
from neural_shadows.metrics.find_lpips import find_lpips


def test_records_of_their_writers(tmp_path, monkeypatch):
    trimesh.creation.box().export(tmp_path / "box.ply")
    report = prepare_mesh(tmp_path / "box.ply", tmp_path / "m.ply", tmp_path / "m.json", name="box")
    assert records.read_mesh_report(tmp_path / "m.json") == report
    monkeypatch.setattr("neural_shadows.metrics.find_lpips.Lpips", lambda *_: None)
    find_lpips(tmp_path / "lpips.json", net="alex", trunk=None)
    assert records.read_lpips_choice(tmp_path / "lpips.json")["available"] is True


def written(path: Path, **changes) -> Path:
    path.write_text(json.dumps(COST | changes))
    return path


def test_the_whole_content_is_given(tmp_path):
    assert records.read_cost(written(tmp_path / "c.json")) == COST


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ({"size": "many"}, "size: Input should be a valid integer"),
        ({"size": 1.5}, "size: Input should be a valid integer"),
        ({"size": True}, "size: Input should be a valid integer"),
        ({"stages": [COST["stages"][0] | {"seconds": float("nan")}]}, "stages.0.seconds: .*finite"),
        ({"stages": [{}]}, "stages.0.stage: Field required"),
        ({"machine": None}, "machine: Input should be a valid dictionary"),
    ],
)
def test_what_is_no_record_is_moved_aside(tmp_path, changes, reason):
    path = written(tmp_path / "c.json", **changes)
    with pytest.raises(InputError, match=rf"c\.json: no file of costs \({reason}.*moved to"):
        records.read_cost(path)
    assert [left.name for left in tmp_path.iterdir()] == ["c.json.broken"]
