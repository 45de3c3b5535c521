import numpy as np
from evaluated import FRAMES, SCENE, make_evaluated

from neural_shadows.evaluation import time_views as stage
from neural_shadows.evaluation.ray_network import open_network
from neural_shadows.evaluation.time_methods import time_methods
from neural_shadows.files.whole_files import read_json
from neural_shadows.networks.object_space.shadow_network import ShadowNetwork
from neural_shadows.rendering.gbuffer import GBuffer
from neural_shadows.shadow_maps import rasterise


def test_frame_times(tmp_path, monkeypatch):
    """By a clock in whose seconds rendering takes 1, a query 2, shading 4 and a map 8.

    And 16 to bring what a method says of lit sides to all points, whatever the method.
    """
    clock = [0.0]

    def slow(owner, name, seconds):
        function = getattr(owner, name)

        def taking(*arguments, **settings):
            clock[0] += seconds
            return function(*arguments, **settings)

        monkeypatch.setattr(owner, name, taking)

    files = make_evaluated(tmp_path)
    monkeypatch.setattr(stage.time, "perf_counter", lambda: clock[0])
    slow(stage, "render_gbuffer", 1)
    slow(ShadowNetwork, "depths", 2)
    opened = []
    whole = stage.timed_network
    monkeypatch.setattr(stage, "timed_network", lambda *net: opened.append(net) or whole(*net))
    slow(stage, "shade", 4)
    slow(rasterise, "rasterised_heights", 8)
    slow(GBuffer, "visibility", 16)
    maps = ["shadow_map_32", "shadow_map_pcf_16bit_32_biased"]
    methods = ["ray_traced", "no_shadow", *maps, "net", "net_biased"]
    size = {"width": 120, "height": 80, "repeats": 5}
    given = {"scene": SCENE, "views": FRAMES, "frame_times": size, "device": "cpu"}
    experiments = {method: "net" if "net" in method else None for method in methods}
    times_json = tmp_path / "ball.json"
    inputs = [], [files.mesh_ply], [], [files.weights], []
    time_methods(*inputs, times_json, methods=experiments, **given)
    times = read_json(times_json)
    assert times["scene"] == tmp_path.name and times["views"] == 5 and times["machine"]["cpu"]
    own = {name: values["own_ms"] for name, values in times["methods"].items()}
    seconds = dict(zip(methods, [16, 16, 24, 24, 18, 18]))
    assert own == {name: 5 * [1000 * value] for name, value in seconds.items()}
    for name, values in times["methods"].items():
        assert values["ms"] == 5 * [5000 + 1000 * seconds[name]] and values["device"] == "cpu"
    weights = open_network(files.weights, "cpu", 1)[0].resident_bytes()
    resident = [values["resident_bytes"] for values in times["methods"].values()]
    assert resident == [None, None, 4 * 32**2, 2 * 32**2, weights, weights]
    assert 0 < times["sphere_rays"] <= 120 * 80
    assert list(times["rays_per_second"]) == methods[4:] and len(opened) == 1
    for rates in times["rays_per_second"].values():
        assert np.median(rates) == times["sphere_rays"] / 18 and len(rates) == 5
