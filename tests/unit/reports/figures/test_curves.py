"""The figures of what was measured: losses, widths, costs, fronts."""

import numpy as np
import pandas as pd

from neural_shadows.reports.figures import loss, pareto, widths
from neural_shadows.reports.figures.cost import cost_figure
from neural_shadows.reports.figures.style import write_figure

NAN = float("nan")


def test_losses_are_drawn_over_their_samples_twice_alike(tmp_path):
    # A first spike does not squeeze the rest.
    losses = {"one": [900.0, *np.linspace(1, 0.1, 200)], "two": [1.0, 0.25]}
    curves = {
        name: pd.DataFrame({"samples": 1024 * np.arange(1, len(values) + 1), "loss": values})
        for name, values in losses.items()
    }
    written = []
    for _ in range(2):
        (axes,) = (figure := loss.loss_figure(curves, title="Losses")).axes
        write_figure(figure, tmp_path / "f.png", tmp_path / "f.svg")
        written.append([path.read_bytes() for path in sorted(tmp_path.iterdir())])
    assert written[0] == written[1] and b"<dc:date>" not in written[0][1]
    np.testing.assert_array_equal(axes.lines[2].get_data(), [[1024, 2048], [1.0, 0.25]])
    labels = [text.get_text() for text in axes.get_legend().get_texts()]
    assert labels == ["one (at the end 0.1)", "two (at the end 0.25)"]
    assert axes.get_ylim()[1] < 10
    means = [loss.smoothed(values) for values in (np.arange(500.0), np.linspace(5, 1, 500))]
    np.testing.assert_allclose(means[1], 5 - 4 * means[0] / 499)  # of a line, on it


def test_lines_of_each_scene_over_width():
    table = {
        "method": ["64", "256", "64", "256", "ray traced"],
        "scene": ["dragon", "dragon", "landscape", "landscape", "dragon"],
        "frame_ms": [10.0, 30.0, 11.0, 31.0, 5.0],
        "lpips": [0.09, 0.04, 0.03, 0.02, NAN],
        "thesis_frame_ms": [11.5, 29.1, 13.2, 32.8, NAN],
        "thesis_lpips": [0.0894, 0.0379, 0.0279, 0.021, NAN],
    }
    table |= {f"lpips_{end}": table["lpips"] for end in ("low", "high")}
    table |= {f"frame_ms_{end}": table["frame_ms"] for end in ("q1", "q3")}
    table = pd.DataFrame(table)
    of = {(scene, str(w)): w for scene in ("dragon", "landscape") for w in (256, 64)}
    quality, speed = widths.width_figure(table, of, title="Widths").axes
    ours = [line.lines[0] for line in quality.containers]
    assert [line.get_xdata().tolist() for line in ours] == [[64, 256], [64, 256]]
    assert [line.get_ydata().tolist() for line in ours] == [[0.09, 0.04], [0.03, 0.02]]
    dashed = [line for line in speed.lines if line.get_linestyle() == "--"]
    assert [line.get_ydata().tolist() for line in dashed] == [[11.5, 29.1], [13.2, 32.8]]


def test_a_line_for_each_stage_with_its_exponent():
    sizes = {"over": "samples", "size": [10, 100, 10, 100], "stage": ["rays"] * 2 + ["labels"] * 2}
    values = {"seconds": [1.0, 10, 2, 2], "memory_mib": [5.0, 5, 0, 0]}
    exponents = {"seconds_exponent": [1.0, 1, 0, 0], "memory_mib_exponent": 0.0}
    seconds, memory = cost_figure(pd.DataFrame({**sizes, **values, **exponents}), title="C").axes
    assert [line.get_label() for line in seconds.lines] == ["rays (1.00)", "labels (0.00)"]
    assert [line.get_label() for line in memory.lines] == ["rays (0.00)"]  # 0 has no logarithm


def test_front_is_what_nothing_else_undercuts():
    rng = np.random.default_rng(0)
    cost, error = rng.integers(0, 12, (2, 40)).astype(float)
    points = np.stack([cost, error], axis=1)
    undercut = [(np.all(points <= p, axis=1) & np.any(points < p, axis=1)).any() for p in points]
    found = pareto.front(cost, error)
    assert {*map(tuple, points[found])} == {*map(tuple, points[~np.array(undercut)])}
    assert (np.diff(cost[found]) > 0).all() and (np.diff(error[found]) < 0).all()


def test_panels_name_the_front_and_what_trains_nothing():
    methods = ["ray_traced", "shadow_map_512", "shadow_map_256", "field_biased", "dragon"]
    table = {
        "method": ["Ray traced", "512²", "256²", "Field", "Thesis"],
        "encoding": [None, None, None, "occupancy_field", "frequency"],
        "lpips": np.array([NAN, 0.01, 0.02, 0.005, 0.09]),
        "bytes": [NAN, 2.0**20, 2.0**18, 7e5, 2e6],
        "frame_ms": [5.0, 60.0, 20.0, 30.0, 900.0],
        "training_seconds": [NAN, NAN, NAN, 20.0, 300.0],
    }
    for name, factor in (("lpips_low", 0.9), ("lpips_high", 1.2)):
        table[name] = factor * table["lpips"]
    kinds = [*map(pareto.kind_of, methods, table["encoding"])]
    legend = ["ray traced", "shadow map", "shadow map", "occupancy field", "thesis's network"]
    assert kinds == legend
    figure = pareto.pareto_figure(pd.DataFrame({**table, "kind": kinds}), title="Dragon")
    named = [{text.get_text() for text in axes.texts} for axes in figure.axes]
    # A map is a line to come below where it has no training to show.
    traced = {"ray traced: 0", "256²", "Field"}
    assert named == [{"256²", "Field"}, traced, {"512²", "256²", "Field"}]
