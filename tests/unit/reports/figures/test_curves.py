"""Figures of measurements: losses, widths, fronts."""

from xml.etree import ElementTree

import numpy as np
import pandas as pd
import pytest
from report_samples import row

from neural_shadows.reports.drawing.chart import points_with_tooltips
from neural_shadows.reports.drawing.point_labels import label_points
from neural_shadows.reports.drawing.style import new_figure, write_figure
from neural_shadows.reports.figures import loss, pareto, widths

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


def test_a_curve_ends_where_its_training_diverged():
    alive = pd.DataFrame({"samples": [64, 128, 192], "loss": [1.0, 0.5, 0.25]})
    dead = pd.DataFrame({"samples": [64, 128, 192], "loss": [1.0, 2.0, NAN]})
    never = pd.DataFrame({"samples": [64], "loss": [NAN]})
    curves = {"alive": alive, "dead": dead, "never": never}
    diverged = {"alive": None, "dead": 1300, "never": 1}
    (axes,) = loss.loss_figure(curves, diverged, title="Losses").axes
    labels = [text.get_text() for text in axes.get_legend().get_texts()]
    assert labels[0] == "alive (at the end 0.25)"
    assert labels[1:] == ["dead (diverged at step 1,300)", "never (diverged at step 1)"]
    (cross,) = [line for line in axes.lines if line.get_marker() == "X"]
    assert cross.get_xydata().tolist() == [[128, 2]]


def widths_table(**changes):
    """The table behind figure 4.8, of two scenes."""
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


@pytest.mark.parametrize(
    ("missing", "shown"),
    [
        (["thesis_lpips", "thesis_frame_ms"], ["LPIPS (squ", "frame time"]),  # another mesh
        (["lpips"], ["LPIPS as t", "frame time"]),
    ],
)
def test_widths_of_what_is_there(missing, shown):
    table = widths_table(**dict.fromkeys(missing, [NAN] * 5))
    figure = widths.width_figure(table, WIDTHS, title="Widths")
    assert [axes.get_ylabel()[:10] for axes in figure.axes] == shown


def test_the_front_has_all_optimal_points():
    rng = np.random.default_rng(0)
    cost, error = rng.integers(0, 12, (2, 40)).astype(float)
    points = np.stack([cost, error], axis=1)
    undercut = [(np.all(points <= p, axis=1) & np.any(points < p, axis=1)).any() for p in points]
    indices = pareto.front(cost, error)
    assert {*map(tuple, points[indices])} == {*map(tuple, points[~np.array(undercut)])}
    assert (np.diff(cost[indices]) > 0).all() and (np.diff(error[indices]) < 0).all()


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
    """The CSV of a table of networks for `pareto.draw`."""
    names = ["method", "encoding", "samples", "lpips", "psnr"]
    names += ["stored_bytes", "own_ms", "build_seconds"]
    table = pd.DataFrame([*METHODS.values(), PRINTED], columns=names)
    table = table.assign(
        scene="dragon", psnr_pooled=table["psnr"], resident_bytes=table["stored_bytes"]
    )
    table.loc[len(table) - 1, "psnr_pooled"] = NAN
    table["learned"] = [{"Field": True, "Thesis": False}.get(name) for name in table["method"]]
    table["coded"] = table["method"] == "Field"
    for metric in ("lpips", "flip", "psnr_pooled"):
        for end, factor in (("", 1), ("_low", 0.9), ("_high", 1.2)):
            table[metric + end] = factor * table.get(metric, NAN)
    table.to_csv(folder / "beyond.csv", index=False)
    return folder / "beyond.csv"


@pytest.fixture
def drawn(tmp_path):
    """The fronts of `METHODS` over some costs, as a figure."""
    table = written_fronts(tmp_path)
    rows = [
        row(key, values[0]) | {"encoding": values[1], "trained": values[2] > 0}
        for key, values in METHODS.items()
    ]
    return lambda costs: pareto.draw(table, "Dragon", costs, rows)


def test_panels_name_points_and_methods_without_a_cost(drawn):
    panels = np.array((figure := drawn([*pareto.COSTS])).axes).reshape(4, 2)
    named = [[{text.get_text() for text in axes.texts} for axes in row] for row in panels]
    printed = "Thesis's network, as printed"
    lines = [
        {"No shadow", f"{printed} {note}"}
        for note in ("(of another LPIPS network)", "(pooled or mean)")
    ]
    assert all(line <= names for row in named for line, names in zip(lines, row))
    stored, own, build = (panels[i, 0] for i in (0, 2, 3))
    # Stored: a filtered map of the same bytes is better than a plain one.
    joined = [line for line in stored.lines if line.get_color() == "#bbbbbb"]
    assert joined[0].get_ydata().tolist() == [0.018, 0.005, 0.001]
    # Own time: exact ray tracing is a cost without an error.
    assert " ray traced: exact" in named[2][0] and own.get_xlabel().startswith("own time")
    # A map needs no building, and is a line to come below.
    assert {"512²", "256²"} <= named[3][0] and len(build.containers) == 4
    hollow = [line for line in stored.lines if line.get_markerfacecolor() == "none"]
    assert [line.get_xdata().tolist() for line in hollow] == [[2e6 / 1024]]
    legend = [text.get_text() for text in figure.legends[0].get_texts()]
    assert legend[0] == "shadow map" and legend[-2:] == ["not learned", "coded"]
    assert legend[-3] == "the best quality at each cost"  # what the grey line says
    edged = [line for line in stored.lines if line.get_markeredgecolor() == "black"]
    assert [line.get_ydata().tolist() for line in edged] == [[METHODS["field_biased"][3]]]
    assert "exact shadow" not in legend and "no method" not in legend


def test_the_first_front_has_one_panel(drawn):
    (axes,) = drawn(["stored_bytes"]).axes
    assert axes.get_ylabel().startswith("pooled PSNR")
    assert {"Field", "Mesh", "512²"} <= {text.get_text() for text in axes.texts}


def test_names_cover_neither_points_nor_lines_nor_each_other():
    figure = new_figure("Names", 5, 4)
    axes = figure.subplots()
    points = np.random.default_rng(0).uniform(0, 1, (40, 2))
    axes.plot(*points.T, "o")
    axes.plot([0, 1], [0, 1])
    figure.draw_without_rendering()
    label_points(axes, points, [f"point {i}" for i in range(40)], fontsize=7)
    boxes = [text.get_window_extent() for text in axes.texts]
    assert 20 < len(boxes) < 40
    assert not any(a.overlaps(b) for i, a in enumerate(boxes) for b in boxes[:i])
    along = axes.transData.transform(np.linspace(0, 1, 500)[:, None].repeat(2, axis=1))
    for crossed in (axes.transData.transform(points), along):
        assert not any(box.count_contains(crossed) for box in boxes)


def test_a_line_leads_to_a_name_that_another_point_is_as_near_to():
    axes = new_figure("Names", 5, 4).subplots()
    points = np.random.default_rng(0).uniform(0, 1, (50, 2))
    axes.plot(*points.T, "o")
    axes.figure.draw_without_rendering()
    limits = *axes.get_xlim(), *axes.get_ylim()
    label_points(axes, points, [str(i) + " is its name" for i in range(50)], fontsize=7)
    leaders = {tuple(line.get_xydata()[0].round(9)) for line in axes.lines[1:]}
    centres = axes.transData.transform(points)
    for text in axes.texts:
        box, own = text.get_window_extent(), int(text.get_text().split(" ")[0])
        far = np.linalg.norm(centres - np.clip(centres, box.min, box.max), axis=1)
        clear = 1.5 * far[own] <= np.delete(far, own).min()
        assert clear or tuple(points[own].round(9)) in leaders
    assert 3 < len(leaders) < len(axes.texts) and (*axes.get_xlim(), *axes.get_ylim()) == limits


def test_the_first_names_may_stand_farther_off():
    """Such as those of networks, which a chart must name."""
    points = np.random.default_rng(0).uniform(0, 1, (50, 2))
    named = []
    for far in (0, 25):
        axes = new_figure("Names", 7, 6).subplots()
        axes.plot(*points.T, "o")
        axes.figure.draw_without_rendering()
        label_points(axes, points, [f"the point {i}" for i in range(50)], far=far, fontsize=7)
        named.append({int(text.get_text().split(" ")[2]) for text in axes.texts})
    few, more = ({i for i in names if i < 25} for names in named)
    assert few < more and len(more) > 20


def test_points_have_tooltips_in_the_svg(tmp_path):
    figure = new_figure("Chart", 4, 3)
    points_with_tooltips(figure.subplots(), [1, 2], [3, 4], ["one & <two>", "three"])
    write_figure(figure, tmp_path / "c.png", tmp_path / "c.svg")
    root = ElementTree.parse(tmp_path / "c.svg").getroot()
    svg = "{http://www.w3.org/2000/svg}"
    groups = [group for group in root.iter(f"{svg}g") if group.get("class") == "says"]
    assert [group.find(f"{svg}title").text for group in groups] == ["one & <two>", "three"]
    assert all(group.find(f"{svg}circle").get("cx") for group in groups)
    assert "Chart" in [text.text for text in root.iter(f"{svg}text")]  # text, and no outlines
