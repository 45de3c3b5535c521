from neural_shadows.evaluation import cost_stages
from neural_shadows.evaluation import measure_cost as measure_cost_file
from neural_shadows.evaluation.cost_stages import NEEDED, TINY, bumpy_sphere, run_alone
from neural_shadows.evaluation.costs import STAGES
from neural_shadows.evaluation.measure_cost import BASE, measure_cost, size_of
from neural_shadows.files.whole_files import read_json

SETTINGS = {"seed": 0, "device": "cpu", "threads": 1}


def test_sizes_are_shown_as_what_they_make():
    assert size_of("subdivisions", 3) == ("triangles", len(bumpy_sphere(3).faces))
    assert size_of("frame_width", 600) == ("pixels", 600 * 400)
    assert set(STAGES) == set(BASE) == set(TINY)


def test_each_stage_is_measured(tmp_path, monkeypatch):
    monkeypatch.setitem(cost_stages.TRAINING, "steps", 5)
    for stage in NEEDED:
        cost = run_alone(stage, tmp_path, TINY, SETTINGS)
        assert cost["seconds"] > 0 and cost["peak_bytes"] > cost["bytes"] >= 0


def test_what_a_killed_measurement_left_is_removed(tmp_path, monkeypatch):
    def in_process(stage, folder, sizes, settings):
        return {"seconds": 1.0, "files": sorted(path.name for path in folder.iterdir())}

    monkeypatch.setattr(measure_cost_file, "_in_process", in_process)
    left = tmp_path / "samples.4.unfinished" / "origins.npy"
    left.parent.mkdir()
    left.write_bytes(b"gigabytes")
    measure_cost(tmp_path / "samples.4.json", over="samples", value=4, **SETTINGS)
    assert [path.name for path in tmp_path.iterdir()] == ["samples.4.json"]
    cost = read_json(tmp_path / "samples.4.json")
    assert (cost["over"], cost["size"]) == ("samples", 4)
    found = {stage["stage"]: stage["files"] for stage in cost["stages"]}
    assert found == dict.fromkeys(STAGES["samples"], [])
