import numpy as np
from evaluated import FRAMES, SCENE, make_evaluated

from neural_shadows.evaluation import measure_frame_times as stage
from neural_shadows.evaluation.measure_frame_times import measure_frame_times
from neural_shadows.files.whole_files import read_json
from neural_shadows.networks.object_space.shadow_network import ShadowNetwork


def test_frame_times(tmp_path, monkeypatch):
    """By a clock in whose seconds rendering takes 1, a network's query 2 and shading 4."""
    clock = [0.0]

    def slow(owner, name, seconds):
        function = getattr(owner, name)

        def taking(*arguments):
            clock[0] += seconds
            return function(*arguments)

        monkeypatch.setattr(owner, name, taking)

    files = make_evaluated(tmp_path)
    monkeypatch.setattr(stage.time, "perf_counter", lambda: clock[0])
    slow(stage, "render_gbuffer", 1)
    slow(ShadowNetwork, "depths", 2)
    slow(stage, "shade", 4)
    methods = ["ray_traced", "shadow_map_32", "net", "net_biased"]
    size = {"width": 120, "height": 80, "repeats": 5}
    given = {"scene": SCENE, "frames": FRAMES, "frame_times": size, "device": "cpu"}
    times_json = tmp_path / "ball.json"
    measure_frame_times(files.mesh_ply, [files.weights], times_json, methods=methods, **given)
    times = read_json(times_json)
    assert times["scene"] == "ball" and times["views"] == 5 and times["machine"]["cpu"]
    seconds = {method: values["ms"] for method, values in times["methods"].items()}
    assert seconds == {method: 5 * [7000 if "net" in method else 5000] for method in methods}
    assert 0 < times["sphere_rays"] <= 120 * 80
    for method in methods[2:]:
        assert np.median(times["rays_per_second"][method]) == times["sphere_rays"] / 2
        assert len(times["rays_per_second"][method]) == 5
