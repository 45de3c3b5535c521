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
        (axes,) = (figure := loss.loss_figure(curves, dict.fromkeys(curves), title="Losses")).axes
        write_figure(figure, tmp_path / "f.png", tmp_path / "f.svg")
        written.append([path.read_bytes() for path in sorted(tmp_path.iterdir())])
    assert written[0] == written[1] and b"<dc:date>" not in written[0][1]
    np.testing.assert_array_equal(axes.lines[2].get_data(), [[1024, 2048], [1.0, 0.25]])
    labels = [text.get_text() for text in axes.get_legend().get_texts()]
    assert labels == ["one (at the end 0.1)", "two (at the end 0.25)"]
    assert axes.get_ylim()[1] < 10
    means = [loss.smoothed(values) for values in (np.arange(500.0), np.linspace(5, 1, 500))]
    np.testing.assert_allclose(means[1], 5 - 4 * means[0] / 499)  # of a line, on it


def test_a_curve_ends_where_its_training_died():
    alive = pd.DataFrame({"samples": [64, 128, 192], "loss": [1.0, 0.5, 0.25]})
    dead = pd.DataFrame({"samples": [64, 128, 192], "loss": [1.0, 2.0, NAN]})
    never = pd.DataFrame({"samples": [64], "loss": [NAN]})
    curves = {"alive": alive, "dead": dead, "never": never}
    died = {"alive": None, "dead": 1300, "never": 1}
    (axes,) = loss.loss_figure(curves, died, title="Losses").axes
    labels = [text.get_text() for text in axes.get_legend().get_texts()]
    assert labels[0] == "alive (at the end 0.25)"
    assert labels[1:] == ["dead (died at step 1,300)", "never (died at step 1)"]
    (cross,) = [line for line in axes.lines if line.get_marker() == "X"]
    assert cross.get_xydata().tolist() == [[128, 2]]


def widths_table(**changes):
    """What figure 4.8 reads, of two scenes."""
    table = {
        "method": ["64", "256", "64", "256", "ray traced"],
        "scene": ["dragon", "dragon", "landscape", "landscape", "dragon"],
        "frame_ms": [10.0, 30.0, 11.0, 31.0, 5.0],
        "own_ms": [5.0, 25.0, 6.0, 26.0, 1.0],
        "lpips": [0.09, 0.04, 0.03, 0.02, NAN],
        "thesis_frame_ms": [11.5, 29.1, 13.2, 32.8, NAN],
        "thesis_lpips": [0.0894, 0.0379, 0.0279, 0.021, NAN],
        "learned": ["True", "True", "False", "True", NAN],
        "lpips_net": "squeeze",
    } | changes
    table |= {f"lpips_{end}": table["lpips"] for end in ("low", "high")}
    table |= {f"{ms}_{end}": table[ms] for ms in ("frame_ms", "own_ms") for end in ("q1", "q3")}
    return pd.DataFrame(table)


WIDTHS = {(scene, str(w)): w for scene in ("dragon", "landscape") for w in (256, 64)}


def test_lines_of_each_scene_over_width_and_the_thesis_on_axes_of_its_own():
    figure = widths.width_figure(widths_table(), WIDTHS, title="Widths")
    quality, theirs, speed = figure.axes
    ours = [line.lines[0] for line in quality.containers]
    assert [line.get_xdata().tolist() for line in ours] == [[64, 256], [64, 256]]
    assert [line.get_ydata().tolist() for line in ours] == [[0.09, 0.04], [0.03, 0.02]]
    # Whole frames and the network's own time, in turn.
    times = [line.lines[0].get_ydata().tolist() for line in speed.containers]
    assert times == [[10, 30], [5, 25], [11, 31], [6, 26]]
    printed = [
        [line.get_ydata().tolist() for line in axes.lines if line.get_ls() == "--"]
        for axes in (theirs, speed)
    ]
    assert printed == [[[0.0894, 0.0379], [0.0279, 0.021]], [[11.5, 29.1], [13.2, 32.8]]]
    assert quality.get_ylabel().startswith("LPIPS (squeeze)")
    assert "another LPIPS network" in theirs.get_title()
    hollow = [line for line in quality.lines if line.get_markerfacecolor() == "none"]
    assert [line.get_xydata().tolist() for line in hollow] == [[[64, 0.03]]]


def test_widths_of_another_mesh_have_no_axes_for_the_thesis():
    nothing = dict.fromkeys(["thesis_lpips", "thesis_frame_ms"], NAN)
    figure = widths.width_figure(widths_table(**nothing), WIDTHS, title="Widths")
    assert len(figure.axes) == 2


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


METHODS = {  # key: label, encoding, samples, LPIPS, PSNR, stored bytes, own ms, build s
    "ray_traced": ("Ray traced", None, NAN, NAN, NAN, NAN, 5, NAN),
    "shadow_map_512": ("512²", None, NAN, 0.01, 35, 2**20, 60, NAN),
    "shadow_map_256": ("256²", None, NAN, 0.02, 32, 2**18, 20, NAN),
    "shadow_map_pcf_256": ("256², PCF", None, NAN, 0.018, 34, 2**18, 25, NAN),
    "dragon_mesh": ("Mesh", "mesh", 0, 0.001, 46, 3e6, 30, 2),
    "dragon_distances": ("Distances", "occupancy_field", 0, 0.008, 39, 7e5, 40, 10),
    "field_biased": ("Field", "occupancy_field", 3e7, 0.005, 41, 7e5, 31, 20),
    "dragon": ("Thesis", "frequency", 2e7, 0.2, 13, 2e6, 900, 300),
    "no_shadow": ("No shadow", None, NAN, 0.2, 13, NAN, 0.1, NAN),
    "all_dark": ("All dark", None, NAN, 0.4, 8, NAN, 0.1, NAN),
}
PRINTED = ("Thesis's network, as printed", None, NAN, 0.0379, 27.39, NAN, NAN, NAN)


def written_fronts(folder):
    """The CSV of a table of networks, as `pareto.draw` reads it."""
    names = (
        "method",
        "encoding",
        "samples",
        "lpips",
        "psnr",
        "stored_bytes",
        "own_ms",
        "build_seconds",
    )
    table = pd.DataFrame([*METHODS.values(), PRINTED], columns=names)
    table = table.assign(
        scene="dragon", psnr_pooled=table["psnr"], resident_bytes=table["stored_bytes"]
    )
    table.loc[len(table) - 1, "psnr_pooled"] = NAN
    table["learned"] = [{"Field": True, "Thesis": False}.get(name) for name in table["method"]]
    for metric in ("lpips", "flip", "psnr_pooled"):
        for end, factor in (("", 1), ("_low", 0.9), ("_high", 1.2)):
            table[metric + end] = factor * table.get(metric, NAN)
    table.to_csv(folder / "beyond.csv", index=False)
    return folder / "beyond.csv"


def test_kinds_of_methods():
    kinds = [pareto.kind_of(key, row[1] or NAN, row[2]) for key, row in METHODS.items()]
    assert kinds == [
        *("ray traced", "shadow map", "shadow map", "filtered or 16-bit shadow map", "mesh"),
        *("distances, untrained", "occupancy field", "thesis's network", "no shadow", "all dark"),
    ]


def test_panels_name_the_front_and_what_costs_nothing(tmp_path, monkeypatch):
    drawn = []
    monkeypatch.setattr(pareto.style, "write_figure", lambda figure, *paths: drawn.append(figure))
    rows = [{"method": key, "label": row[0]} for key, row in METHODS.items()]
    settings = {"title": "Dragon", "scene": "dragon", "rows": rows, "run": {"scale": "test"}}
    pareto.draw(written_fronts(tmp_path), tmp_path / "p.png", tmp_path / "p.svg", **settings)
    panels = np.array(drawn[0].axes).reshape(2, 4)
    named = [[{text.get_text() for text in axes.texts} for axes in row] for row in panels]
    printed = "Thesis's network, as printed"
    lines = [
        {"No shadow", f"{printed} {note}"}
        for note in ("(of another LPIPS network)", "(mean, not pooled)")
    ]
    # Stored: a filtered map of the same bytes is better than a plain one.
    assert named[0][0] - lines[0] == named[1][0] - lines[1] == {"256², PCF", "Field", "Mesh"}
    # Own time: exact ray tracing is a cost without an error.
    assert named[0][2] - lines[0] == {"256²", "256², PCF", "Mesh", " ray traced: exact"}
    # A map needs no building, and is a line to come below.
    assert named[0][3] - lines[0] == {"512²", "256²", "Mesh"}
    assert all(line <= names for line, row in zip(lines, named) for names in row)
    hollow = [
        line
        for line in panels[0, 0].lines
        if line.get_markerfacecolor() == "none" and line.get_marker() == "o"
    ]
    assert [line.get_xdata().tolist() for line in hollow] == [[2e6 / 1024]]
    legend = [text.get_text() for text in drawn[0].legends[0].get_texts()]
    assert legend[0] == "shadow map" and legend[-1] == "not learned" and "ray traced" not in legend
