import pytest
from evaluated import FRAMES, SCENE, make_evaluated

from neural_shadows.evaluation import measure_frame_times as stage
from neural_shadows.evaluation.measure_frame_times import measure_frame_times, shadow_times
from neural_shadows.evaluation.references import References
from neural_shadows.files.whole_files import read_json


def test_frame_times(tmp_path, monkeypatch):
    files = make_evaluated(tmp_path)
    methods, size = ["ray_traced", "shadow_map_32", "net", "net_biased"], (120, 80)
    measure_frame_times(
        files.mesh_ply,
        [files.weights],
        tmp_path / "ball.json",
        methods=methods,
        scene=SCENE,
        frames=FRAMES,
        frame_times={"width": 120, "height": 80, "repeats": 5},
        device="cpu",
    )
    times = read_json(tmp_path / "ball.json")
    assert times["scene"] == "ball" and (times["width"], times["height"]) == size
    assert list(times["methods"]) == methods
    for values in times["methods"].values():
        assert len(values["ms"]) == 5 and min(values["ms"]) > 0
    assert times["views"] == 5 and times["device"] == "cpu" and times["machine"]["cpu"]
    assert 0 < times["sphere_rays"] <= 120 * 80
    assert {method: len(found) for method, found in times["rays_per_second"].items()} == {
        "net": 5,
        "net_biased": 5,
    }

    # Milliseconds, of each method alone.
    frame, truth = next(iter(References(files.references)))
    clock = [0.0]
    monkeypatch.setattr(stage.time, "perf_counter", lambda: clock[0])

    def taking(seconds):
        def answer(frame):
            clock[0] += seconds
            return truth

        return answer

    times = shadow_times({"a": taking(0.25), "b": taking(1.5)}, frame)
    assert times == {"a": pytest.approx(250), "b": pytest.approx(1500)}
