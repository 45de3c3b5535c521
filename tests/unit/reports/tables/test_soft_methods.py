"""The table of methods for soft shadows, and its figures, from made numbers."""

import numpy as np
import pandas as pd
import pytest
import report_samples as samples

from neural_shadows.evaluation.metric_files import write_metrics
from neural_shadows.reports.data.frame_means import ERROR_COLUMNS
from neural_shadows.reports.data.soft_frames import SoftFrames
from neural_shadows.reports.data.table import with_ends
from neural_shadows.reports.figures import soft_equal_time
from neural_shadows.reports.tables import soft_methods

LABELS = {"hard": "Shadow map", "rt_4": "4 rays", "pcss_post": "PCSS, filtered"}
LABELS |= {"no_shadow": "No shadow"}
MSE = {"hard": 0.02, "rt_4": 0.01, "pcss_post": 0.005, "no_shadow": 0.1}
BY_NONE = {"map": None, "texel_floats": 0, "held_bytes": 0}
TIMES = {
    **dict.fromkeys(("hard", "pcss_post"), {"ms": [1.0, 1.0]} | samples.BY_MAP),
    **{"rt_4": {"ms": [4.0, 16.0]} | BY_NONE, "no_shadow": {"ms": [0.1, 0.1]} | BY_NONE},
}


@pytest.fixture
def written(tmp_path):
    paths = []
    for method, mse in MSE.items():
        rows = [
            {"scene": scene, "part": "test_000", "frame": frame, "radius": k, "metric": name}
            | {"value": value}
            for scene in ("room", "tree")
            for frame in range(6)
            for k in (0, 1)
            for name, value in {
                "mse": mse * (1 + k) * (2 if scene == "tree" else 1) + 1e-4 * frame,
                "mse_off_edges": mse / 2 + 1e-4 * (frame - 2.5),
                "l1": mse,
                "mse_umbra": np.nan if frame else mse,
            }.items()
        ]
        key = {"scene": "room", "part": "light_000", "frame": 0, "radius": 1}
        rows.append({**key, "metric": "instability", "value": mse})
        rows.append({**key, "metric": "instability_reference", "value": 0.5})
        paths.append(tmp_path / f"{method}.csv")
        write_metrics(paths[-1], [row | {"method": method} for row in rows])
    chosen = {"constants": {"bias": 3}, "at_end": ["bias"], "mse": 0.1}
    tuned = {"method": "pcss_post", "candidates": {"bias": [1, 3]}, "radii": [chosen] * 2}
    tuned["history"] = chosen | {"constants": {"bias": 3, "share": 0.2}, "at_end": ["share"]}
    tuned["of_history"] = {"share": [0.1, 0.2]}
    records = {
        "times": samples.SOFT_TIMES | {"methods": TIMES},
        **{"lpips": {"available": False}, "frames": samples.SOFT_FRAMES},
        "pcss_post": tuned,
    }
    times, lpips, frames, constants = (
        samples.write_record(tmp_path / f"{name}.json", record) for name, record in records.items()
    )
    return samples.written_table(
        soft_methods.table,
        tmp_path,
        frames_json=frames,
        soft_metrics=paths,
        soft_times=times,
        widths_json=None,
        soft_constants=[constants],
        screen_trainings=[],
        lpips_json=lpips,
        labels=LABELS,
        left_out=["1 ray, OIDN"],
        unseen=["tree"],
        against="rt_4",
    )


def test_means_over_frames_of_all_scenes(written):
    table = written[0].set_index(["method", "number"])
    # All methods of a light stand together.
    assert [*table.index] == [(name, light) for light in (0, 1) for name in LABELS]
    row = table.loc["hard", 1]
    assert row["mse"] == pytest.approx(0.02 * 2 * 1.5 + 2.5e-4) and row["frames"] == 12
    assert row["mse_low"] < row["mse"] < row["mse_high"]
    assert row["mse_unseen"] == pytest.approx(0.02 * 2 * 2 + 2.5e-4)
    assert row["mse_off_edges_low"] < row["mse_off_edges"] == pytest.approx(0.01)
    assert row["psnr_pooled"] == pytest.approx(-10 * np.log10(row["mse"]), abs=1e-3)
    assert row["mse_umbra"] == pytest.approx(0.02)
    assert row["instability"] == row["instability_light"] == 0.02
    assert np.isnan(table.loc["hard", 0]["instability"])


def test_differences_are_of_pairs_of_frames(written):
    table, text = written[0].set_index(["method", "number"]), written[1].read_text()
    row = table.loc["pcss_post", 1]
    # Frames differ by the same in all methods: paired, nothing is left of it.
    ends = with_ends(soft_methods.DIFFERENCE)
    assert [row[end] for end in ends] == pytest.approx([-0.0025] * 3)
    assert np.isnan(table.loc[("rt_4", 1), soft_methods.DIFFERENCE])
    assert "less that of 4 rays, on the same frames of unseen scenes" in text
    assert " -25.0 [-25.0, -25.0] |" in text


def test_what_looks_at_a_map_waits_for_it(written):
    table = written[0].set_index(["method", "number"])
    assert table.loc[("hard", 1), "ms"] == 11 and table.loc[("rt_4", 1), "ms"] == 16
    assert table.loc[("hard", 1), "bytes"] == 256 and table.loc[("rt_4", 1), "bytes"] == 0


def test_notes_say_constants_and_where_they_end(written):
    text = written[1].read_text()
    ends = (f"({name} at an end of the range tried)" for name in ("bias", "share"))
    sentence = "PCSS, filtered, by radius: bias 3, 3 {}; of its history, on validation sequences: share 0.2 {}."
    assert sentence.format(*ends) in text
    assert "machine: 1 ray, OIDN." in text and "light of 0.25 S radius" in text
    assert "[95 % over 12 frames in 2 scenes, room, tree; not valid for others]" in text
    assert "unseen scenes: tree" in text and "FLIP ↓" not in text  # of which there is none here


@pytest.mark.parametrize("unit", ["metres", "degrees"])
def test_a_light_without_extent_has_no_width(tmp_path, unit):
    record = {"radii": [0, 0.25], "radius_unit": unit, "scenes": {"room": [[2, 3], [8, 9]]}}
    widths_json = samples.write_record(tmp_path / "widths.json", record | {"widest": 192})
    files = {"frames_json": widths_json, "widths_json": widths_json}
    soft = SoftFrames(soft_metrics=[], screen_trainings=[], labels={}, **files)
    (note,) = soft.describe_widths()
    light = {"metres": "light of 0.25 m radius", "degrees": "sun of 0.25° radius"}[unit]
    assert f"(least to most): {light} 8 (8 to 8) and 9. Wider" in note


def test_error_over_time(written, tmp_path):
    table_csv = written[1].with_suffix(".csv")
    text = samples.written_figure(soft_equal_time.draw, tmp_path, table_csv=table_csv, radii=None)
    assert "4 rays: MSE 300" not in text and "4 rays: MSE" in text and "16.0 ms" in text
    assert "light of 0.25 S radius" in text and "point light" not in text


@pytest.mark.parametrize(("radii", "named"), [([1], 6), ([0, 1], 7)])
def test_the_legend_is_as_wide_as_the_figure_and_names_what_is_drawn(radii, named):
    """`base_hard` has a time for a point light alone."""
    methods = ["hard", "pcf_3", "pcss", "msm_9", "rt_1", "rt_4_svgf", "no_shadow", "base_hard"]
    rows = [
        {"method": method, "label": method, "number": number, "radius": number, "unit": "m"}
        | {"ms": 1 + k if k < 6 or (method, number) == ("base_hard", 0) else np.nan}
        | dict.fromkeys(ERROR_COLUMNS, 0.1 / (1 + k))
        for k, method in enumerate(methods)
        for number in (0, 1)
    ]
    figure = soft_equal_time.equal_time_figure(pd.DataFrame(rows), radii, title="Equal time")
    figure.draw_without_rendering()
    extent = figure.legends[0].get_window_extent()
    assert extent.x0 >= 0 and extent.x1 <= figure.bbox.x1
    assert len(figure.legends[0].get_texts()) == named
    drawn = figure.axes[0].containers[0].lines[0].get_ydata()[0]  # of `hard`, in the tables' unit
    assert drawn == pytest.approx(1000) and "10⁻⁴" in figure.axes[0].get_ylabel()
    assert figure.axes[0].get_title().endswith("(no shadow: 143)")


def test_a_network_is_named_before_others():
    """So that it keeps its name where there is no room for all."""
    rows = [
        {"method": method, "label": label, "number": 1, "radius": 1, "unit": "m", "ms": 10.0}
        | dict.fromkeys(ERROR_COLUMNS, 0.1)
        for method, label in (("pcss", "PCSS"), ("kpnsm", "Ours"))
    ]
    figure = soft_equal_time.equal_time_figure(pd.DataFrame(rows), [1], title="Equal time")
    assert [text.get_text() for text in figure.axes[0].texts] == ["Ours", "PCSS"]
