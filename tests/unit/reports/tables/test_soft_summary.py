"""Summaries of methods for soft shadows beside printed numbers, and their figure, from made numbers."""

from itertools import product

import numpy as np
import pytest
import report_samples as samples
from report_samples import PUBLISHED as THESIS_CSV

from neural_shadows.evaluation.metric_files import write_metrics
from neural_shadows.reports.figures import soft_radii
from neural_shadows.reports.tables import soft_summary

PUBLISHED = THESIS_CSV.with_name("published_kpnsm.csv")
TIMES = samples.SOFT_TIMES | {"methods": {"pcss": {"ms": [1.0, 3.0]} | samples.BY_MAP}}
MSE = {"mine": 0.001, "pcss": 0.002}
ROWS = [
    {"method": "mine", "label": "Mine", "published": "ours_enhanced", "column": None},
    {"method": "pcss", "label": "PCSS", "published": None, "column": None},
]


@pytest.fixture
def files(tmp_path):
    """Of each method twelve frames of two scenes, the second light and the second scene twice as wrong."""
    paths = []
    for method, mse in MSE.items():
        rows = [
            {"scene": scene, "part": "test_000", "frame": frame, "radius": k, "metric": name}
            | {"value": value * (1 + k) * (2 if scene == "tree" else 1)}
            for scene in ("room", "tree")
            for frame in range(6)
            for k in (0, 1)
            for name, value in {"mse": mse, "ssim": 0.1}.items()
        ]
        moves = {"both": 0.03, "light": 0.02, "camera": 0.01}.items()
        for scene, (what, value) in product(("room", "attic"), moves):
            key = {"scene": scene, "part": f"{what}_000", "frame": 0, "radius": 1}
            value *= 1 + 6 * (scene == "attic")  # is not measured
            rows.append({**key, "metric": "temporal_error", "value": value})
            rows.append({**key, "metric": "temporal_error_reference", "value": value / 2})
            rows.append({**key, "metric": "mse_sequence", "value": mse})
        paths.append(tmp_path / f"{method}.csv")
        write_metrics(paths[-1], [row | {"method": method} for row in rows])
    for name, content in {"times": TIMES, "frames": samples.SOFT_FRAMES}.items():
        samples.write_record(tmp_path / f"{name}.json", content)
    return paths


def summary(folder, files, **told):
    given = {"published": "kpnsm.1", "methods": ROWS, "by": None, "metrics": ["mse", "ssim"]}
    given |= {"soft_times": None, "widths_json": None, "measured": ["room", "tree"], "lights": None}
    data, md = samples.written_table(
        soft_summary.table,
        folder,
        frames_json=folder / "frames.json",
        soft_metrics=files,
        labels={},
        published_kpnsm_csv=PUBLISHED,
        **{**given, **told},
    )
    return data.set_index("method"), md.read_text(encoding="utf-8")


def test_the_mean_over_all_lights_beside_what_is_printed(tmp_path, files):
    times = {"soft_times": tmp_path / "times.json", "metrics": ["mse", "ssim", "time"]}
    table, text = summary(tmp_path, files, **times)
    assert table.loc["mine", "mse"] == pytest.approx(0.001 * 1.5 * 1.5)
    assert table.loc["mine", "printed_mse"] == pytest.approx(9.67e-4)
    assert table.loc["mine", "mse_minus_printed"] == pytest.approx(0.00225 - 9.67e-4, rel=1e-3)
    assert table.loc["mine", "printed_ssim"] == 0.979 and table.loc["mine", "printed_time"] == 8.9
    assert table.loc["pcss", "time"] == 12 and np.isnan(table.loc["pcss", "printed_mse"])
    assert "12 frames of 8 × 4 of room, tree, and 2 radii" in text
    assert "22.50" in text and "9.67" in text and "table 1 of Hu et al. 2025" in text


def test_some_scenes_alone_and_a_printed_grid(tmp_path, files):
    grid = [ROWS[0] | {"published": "layers_5", "column": "filters_3"}]
    told = {"published": "kpnsm.2", "methods": grid, "measured": ["tree"], "metrics": ["mse"]}
    table, text = summary(tmp_path, files, **told)
    assert table.loc["mine", "mse"] == pytest.approx(0.003)
    assert table.loc["mine", "printed_mse"] == pytest.approx(10.19e-4) and "of tree, and" in text


def test_some_lights_alone(tmp_path, files):
    table, text = summary(tmp_path, files, lights=[1])
    assert table.loc["mine", "mse"] == pytest.approx(0.001 * 2 * 1.5) and "and 1 radii of" in text
    by_light, _ = summary(tmp_path, files, published=None, by="radius", lights=[1])
    assert by_light["number"].tolist() == [1, 1]


def test_parts_by_scene_and_by_light(tmp_path, files):
    by_scene, text = summary(tmp_path, files, published=None, by="scene")
    assert by_scene.loc["mine", ["scene", "mse"]].to_numpy().tolist() == [
        *(["room", pytest.approx(0.0015)], ["tree", pytest.approx(0.003)])
    ]
    assert "| scene" in text and "Printed" not in text
    by_light, text = summary(tmp_path, files, published=None, by="radius")
    assert by_light.loc["pcss", "mse"].to_numpy() == pytest.approx([0.003, 0.006])
    assert "light of 0.25 S radius" in text
    table_csv = tmp_path / "table.csv"
    text = samples.written_figure(soft_radii.draw, tmp_path, table_csv=table_csv)
    assert "PCSS: MSE 30.0, 60.0 × 10⁻⁴ by radius" in text
    assert ">PCSS</text>" in text  # beside its line


def test_the_temporal_error_is_that_of_light_and_eye_together(tmp_path, files):
    rows = [ROWS[0] | {"published": "with_temporal_loss", "column": "ours_enhanced"}]
    told = {"published": "kpnsm.3", "methods": rows, "metrics": ["temporal_error", "mse"]}
    table, text = summary(tmp_path, files, **told)
    row = table.loc["mine"]
    assert row["temporal_error"] == 0.03 and row["temporal_error_light"] == 0.02
    assert row["printed_temporal_error"] == pytest.approx(0.0368) and row["mse_sequence"] == 0.001
    assert np.isnan(row["printed_mse"])  # the printed number is of the first metric alone
    assert row["temporal_error_reference"] == 0.015 and "in sequences of room: light" in text
