"""Tables of trained networks on frames, from made numbers; their figures."""

import json

import numpy as np
import pytest
import report_samples as samples
from report_samples import PUBLISHED as THESIS_CSV

from neural_shadows.evaluation.soft_metrics import write_soft_metrics
from neural_shadows.reports.data.frame_means import describe_units
from neural_shadows.reports.data.screen_rows import describe_trainings
from neural_shadows.reports.figures import screen_flicker, screen_sensitivity
from neural_shadows.reports.tables import (
    screen_depth,
    screen_errors,
    screen_features,
    screen_solids,
    screen_steps,
    screen_temporal,
)

PUBLISHED = THESIS_CSV.with_name("published_nsm.csv")
RUN = {"scale": "test", "seed": 1}
TRAINING = {
    "steps": 10,
    "crops": 2,
    "crop": 32,
    "learning_rate": 1e-3,
    "seed": 5,
    "optimiser": "adam",
}
TRAINING |= {"perturbation": 3.0, "perturbation_from": 0.5}
VALIDATIONS = [{"step": step, "mse": [0.9 / step, 1.1 / step]} for step in (1, 4, 7)]
LABELS = {"three": "3 levels", "five": "5 levels"}


def metrics(path, rows):
    key = {"part": "test_000", "frame": 0, "radius": 0, "scene": "plate_90"}
    write_soft_metrics(path, [{**key, **row} for row in rows])
    return path


def training(folder, name, levels, died=None):
    path = folder / name / "training.json"
    path.parent.mkdir()
    record = {"network": {"widths": [8] * levels}, "training": TRAINING, "perceptual": "squeeze"}
    record |= {"validations": VALIDATIONS, "validation_mse": [0.01, 0.03], "died_at_step": died}
    path.write_text(json.dumps(record))
    return path


@pytest.fixture
def trained(tmp_path):
    return [training(tmp_path, "three", 3), training(tmp_path, "five", 5)]


@pytest.fixture
def about(tmp_path):
    path = tmp_path / "frames.json"
    path.write_text(json.dumps({"width": 8, "height": 4, "radii": [0, 0.25]}))
    return path


def written(make, tmp_path, **given):
    table, md = samples.written(make(**given, title="Title", run=RUN), tmp_path)
    return table, md.read_text(encoding="utf-8")


def test_depths_stand_beside_what_is_printed(tmp_path, trained, about):
    """Of the largest light alone, over the frames of each plate."""
    files = [
        metrics(
            tmp_path / f"{name}.csv",
            [
                {"scene": scene, "frame": i, "radius": k, "metric": name, "value": value * (1 + k)}
                for name in ("mse", "mse_widest")
                for scene, value in values.items()
                for i in range(4)
                for k in (0, 1)
            ],
        )
        for name, values in {
            "three": {"plate_21": 0.01, "plate_90": 0.08},
            "five": {"plate_21": 0.02, "plate_90": 0.01},
        }.items()
    ]
    told = {"soft_metrics": files, "trainings": trained, "frames_json": about}
    told |= {"published_nsm_csv": PUBLISHED, "published": "nsm.1", "labels": LABELS}
    columns = {"layers_3": "three", "layers_5": "five"}
    table, text = written(screen_depth.table, tmp_path, columns=columns, **told)
    cells = table.set_index(["row", "column"])
    assert cells["mse"].to_dict() == {
        **{("penumbra_21", "layers_3"): 0.02, ("penumbra_21", "layers_5"): 0.04},
        **{("penumbra_90", "layers_3"): 0.16, ("penumbra_90", "layers_5"): 0.02},
    }
    assert cells["mse_widest"].to_dict() == cells["mse"].to_dict()
    assert cells.loc[("penumbra_90", "layers_3"), "printed_mse"] == 0.083
    assert cells.loc[("penumbra_90", "layers_3"), "mse_minus_printed"] == pytest.approx(0.077)
    assert cells.loc[("penumbra_90", "layers_3"), "ratio"] == 8
    assert cells["receptive_field"].tolist() == [24, 96, 24, 96]
    assert "| 90 px" in text and "8.0 / 1.0" in text and "table 1 of Datta" in text
    assert "perceptual term: squeeze" in text and "3 levels, 5 levels." in text
    assert "3 levels 10,000 after 1, 2,500 after 4, 1,429 after 7, 200 after 10; 5" in text


def test_features_with_their_worth(tmp_path, trained):
    files, shares = [], []
    for name, value in {"three": 0.02, "five": 0.01}.items():
        rows = [
            {"frame": i, "radius": k, "metric": "mse", "value": value * (1 + k)}
            for i in range(4)
            for k in (0, 1)
        ]
        files.append(metrics(tmp_path / f"{name}.csv", rows))
        parts = {"ratio": 0.9, "n": 0.1} if name == "five" else {"ratio": 1.0}
        found = {k: {"share": v, "sensitivity": v, "as_printed": 2 * v} for k, v in parts.items()}
        shares.append(tmp_path / f"{name}.json")
        shares[-1].write_text(json.dumps({"features": found}))
    told = {"soft_metrics": files, "trainings": trained, "sensitivities": shares}
    told |= {"published_nsm_csv": PUBLISHED, "published": "nsm.s1", "labels": LABELS}
    columns = {"features_2": "three", "extraction": "five"}
    table, text = written(screen_features.table, tmp_path, columns=columns, **told)
    assert table["error"].tolist() == [0.03, 0.015] and table["channels"].tolist() == [1, 4]
    assert table["printed_error"].tolist() == [0.00686, 0.00664]  # of the table and of the text
    assert table["share_n"].tolist()[1] == 0.1 and np.isnan(table["share_n"][0])
    assert "ratio 90.0, n 10.0" in text
    outputs = tmp_path / "figure.png", tmp_path / "figure.svg"
    screen_sensitivity.draw(tmp_path / "table.csv", *outputs, title="Worth", run=RUN)
    assert "5 levels, n: 10.0 %" in outputs[1].read_text(encoding="utf-8")


STEPS = {
    "trimmed": {"network": "trimmed", "precision": "float32", "experiment": "five"},
    "trimmed_half": {"network": "trimmed", "precision": "bfloat16", "experiment": "five"},
}


def trimmed_profile(folder, milliseconds: dict[str, float]):
    """A profile that has a whole frame's milliseconds in some number formats."""
    run = {"device": "cpu", "threads": 2, "product_macs": 1e12, "parts": []}
    runs = [run | {"precision": name, "whole_ms": ms} for name, ms in milliseconds.items()]
    profile = {"width": 2048, "height": 1024, "runs": runs, "machine": {"cpu": "a CPU"}}
    profile |= {"repeats": 10, "warm_up": 3, "product_size": 2048}
    profile |= {"levels": [{"weights": 2**18, "macs": 1e4}]}
    path = folder / "trimmed.json"
    path.write_text(json.dumps(profile))
    return path


def test_steps(tmp_path, trained):
    path = trimmed_profile(tmp_path, {"float32": 400.0, "bfloat16": 100.0})
    values = [
        metrics(tmp_path / f"five_{name}.csv", [{"metric": "mse", "value": value, "frame": 0}])
        for name, value in {"float32": 0.006, "bfloat16": 0.007}.items()
    ]
    told = {"profiles": [path], "soft_metrics": values, "trainings": trained[1:]}
    told |= {"published_nsm_csv": PUBLISHED, "steps": STEPS, "labels": LABELS}
    table, text = written(screen_steps.table, tmp_path, published="nsm.steps", **told)
    assert table["runtime"].tolist() == [400, 100] and table["printed_runtime"].tolist() == [28, 17]
    assert table["size"].tolist() == [1, 0.5] and table["error"].tolist() == [0.006, 0.007]
    assert table["share"].tolist() == pytest.approx([2**21 * 1e4 / 0.4e12, 2**21 * 1e4 / 0.1e12])
    assert table["of_printed_size"].all() and " 6.67 |" in text
    table, text = written(screen_steps.table, tmp_path, published=None, **told)
    assert table["printed_runtime"].isna().all() and "Printed" not in text and "400.0" in text
    assert "Not timed" not in text and "Without an error" not in text


def test_steps_in_a_format_that_the_processor_lacks(tmp_path, trained):
    """Their cells are empty, and notes say why."""
    profile = trimmed_profile(tmp_path, {"float32": 400.0})
    values = [
        metrics(tmp_path / "five_float32.csv", [{"metric": "mse", "value": 0.006, "frame": 0}]),
        metrics(tmp_path / "five_bfloat16.csv", []),
    ]
    told = {"profiles": [profile], "soft_metrics": values, "trainings": trained[1:]}
    told |= {"published_nsm_csv": PUBLISHED, "steps": STEPS, "labels": LABELS}
    table, text = written(screen_steps.table, tmp_path, published="nsm.steps", **told)
    half = table.set_index("row").loc["trimmed_half"]
    assert half[["runtime", "share", "error", "run"]].isna().all() and half["size"] == 0.5
    assert table["runtime"][0] == 400 and table["error"][0] == 0.006
    assert "Not timed: bfloat16 on the CPU, which has no instructions" in text
    assert "Without an error: trimmed_half." in text


def test_what_died_is_named(tmp_path):
    """Its numbers are those of a constant answer, and would be read as those of its form."""
    records = {
        name: json.loads(training(tmp_path, name, 3, died).read_text())
        for name, died in {"three": None, "five": 146}.items()
    }
    alike, dead = describe_trainings(records, LABELS)
    assert "3 levels, 5 levels." in alike and "Diverged" in dead
    assert "5 levels at step 146" in dead and "3 levels" not in dead


def test_flicker_by_what_moves(tmp_path, trained, about):
    rows = [
        {"part": f"{kind}_000", "metric": metric, "value": value}
        for kind, factor in {"camera": 1, "light": 2}.items()
        for metric, value in {
            **{"instability": 0.2 * factor, "instability_taa": 0.1 * factor},
            **{"instability_reference": 0.05, "mse_sequence": 0.02, "mse_taa": 0.03},
        }.items()
    ]
    rows.append({"metric": "mse_edge", "value": 0.5})
    files = [metrics(tmp_path / "five.csv", rows)]
    told = {"soft_metrics": files, "trainings": trained[1:], "frames_json": about}
    table, text = written(screen_temporal.table, tmp_path, labels={"five": "Five"}, **told)
    assert table["label"].tolist() == ["Five", "Five + TAA"]
    assert table["e_light"].tolist() == [0.4, 0.2] and table["e_camera"].tolist() == [0.2, 0.1]
    assert table["mse_sequence"].tolist() == [0.02, 0.03] and table["mse_edge"][0] == 0.5
    assert "E, light" in text


def test_what_was_learned_beside_what_was_not(tmp_path, trained, about):
    """Errors of scene and light as they were made; sequences are of the middle light, 1 of two."""
    scenes = {"room": 0.02, "room_dragon": 0.04}
    rows = [
        {"scene": scene, "frame": i, "radius": k, "metric": "mse", "value": value * (1 + k)}
        for scene, value in scenes.items()
        for i in range(4)
        for k in (0, 1)
    ]
    paths = {"scene": "room", "radius": 1, "metric": "mse_sequence"}
    rows += [
        {"scene": scene, "frame": 0, "radius": k, "metric": name, "value": width}
        for scene in scenes
        for k, width in enumerate((2, 12))
        for name in ("width", "width_reference")
    ]
    rows += [paths | {"part": f"{kind}_000", "value": 0.09} for kind in ("camera", "light")]
    files = [metrics(tmp_path / "five.csv", rows)]
    learned = {"scenes": ["room"], "radii": [0, 0.25]}
    learned |= {"train_mse": [0.01, 0.03], "validation_mse": [0.02, None]}
    trained[1].write_text(json.dumps(json.loads(trained[1].read_text()) | learned))
    told = {"soft_metrics": files, "trainings": trained[1:], "frames_json": about}
    table, text = written(screen_errors.table, tmp_path, labels={"five": "Five"}, **told)
    cells = table.set_index(["frames", "light"])
    assert cells["mse"].dropna().to_dict() == {
        **{("training", "0"): 0.01, ("training", "1"): 0.03, ("training", "all"): 0.02},
        ("validation", "0"): 0.02,
        **{("room", "0"): 0.02, ("room", "1"): 0.04, ("room", "all"): 0.03},
        **{("room_dragon", "0"): 0.04, ("room_dragon", "1"): 0.08, ("room_dragon", "all"): 0.06},
        ("sequences", "1"): 0.09,
    }
    assert cells.loc[("room_dragon", "all"), "ratio"] == 3
    assert cells.loc[("sequences", "1"), "ratio"] == 3
    assert cells.loc[("room", "1"), "width"] == 12 and "exact width, px" in text
    assert "room_dragon (unseen)" in text and "room (unseen)" not in text


def test_a_line_over_the_solids_before_the_light(tmp_path, trained, about):
    """Errors of 0.01 a solid, of frames half of whose pixels behind something have two before them.

    A point light, of which they are the ninefold, has no part.
    """
    values = {"mse_solids_1": 0.01, "mse_solids_2": 0.02, "mse_behind": 0.015, "solids_behind": 1.5}
    values |= {"mse_per_solid": 0.01, "mse_solids_3": float("nan")}
    rows = [
        {"frame": i, "radius": k, "metric": name, "value": factor * value}
        for name, value in values.items()
        for i in range(4)
        for k, factor in enumerate((9, 1))
    ]
    told = {"soft_metrics": [metrics(tmp_path / "five.csv", rows)], "trainings": trained[1:]}
    told |= {"frames_json": about}
    table, text = written(screen_solids.table, tmp_path, labels={"five": "Five"}, **told)
    assert table["mse"].tolist()[:2] == [0.01, 0.02] and np.isnan(table["mse"][2])
    assert table["line"].tolist() == pytest.approx([0.01, 0.02, 0.03])
    assert table["slope_low"].tolist() == pytest.approx([0.01] * 3)
    assert "3 and more" in text and "100.0 [100.0, 100.0]" in text


def test_lights_that_a_network_did_not_learn_have_no_training_error(tmp_path, trained, about):
    rows = [{"scene": "room", "radius": k, "metric": "mse", "value": 0.02} for k in (0, 1)]
    learned = {"scenes": ["room"], "radii": [0, 0.5], "train_mse": [1, 1], "validation_mse": [1, 1]}
    trained[1].write_text(json.dumps(json.loads(trained[1].read_text()) | learned))
    told = {"soft_metrics": [metrics(tmp_path / "five.csv", rows)], "trainings": trained[1:]}
    told |= {"frames_json": about, "labels": {"five": "Five"}}
    table, text = written(screen_errors.table, tmp_path, **told)
    assert set(table["frames"]) == {"room"} and table["ratio"].isna().all()
    assert "× training" not in text.splitlines()[2]


def test_maps_of_flicker_are_drawn(tmp_path):
    from neural_shadows.evaluation.soft_answers import flicker_name, write_answers

    part = tmp_path / "room" / "light_000.json"
    image = np.zeros((4, 8))
    image[1, 2] = 0.5
    names = {flicker_name(part): image, flicker_name(part, exact=True): 0 * image}
    write_answers(tmp_path / "five.npz", names)
    outputs = tmp_path / "figure.png", tmp_path / "figure.svg"
    told = {"title": "Flicker", "labels": {"five": "Five"}, "run": RUN}
    screen_flicker.draw([part], [tmp_path / "five.npz"], *outputs, **told)
    assert "Five, light moves: 0.0157" in outputs[1].read_text(encoding="utf-8")


def test_what_learns_nothing_is_in_the_csv_alone(tmp_path, trained, about):
    """On training frames as on those of validation: it has learned neither."""
    errors = {"five": 0.02, "hard": 0.04, "no_shadow": 0.1}
    files = []
    for method, value in errors.items():
        rows = [
            {"scene": "room", "frame": i, "radius": k, "metric": metric, "value": value / part}
            for i in range(4)
            for k in (0, 1)
            for metric, part in {"mse": 1, "mse_off_edges": 2}.items()
        ]
        names = ("instability", "instability_reference")
        rows += [{"metric": name, "part": "light_000", "value": value} for name in names]
        files.append(metrics(tmp_path / f"{method}.csv", rows))
    learned = {"scenes": ["room"], "radii": [0, 0.25], "train_mse": [0.01] * 2}
    learned |= {"validation_mse": [0.02] * 2, "null_mse": {"hard_map": [0.05, 0.07]}}
    trained[1].write_text(json.dumps(json.loads(trained[1].read_text()) | learned))
    told = {"soft_metrics": files, "trainings": trained[1:], "labels": {"five": "Five"}}
    told |= {"frames_json": about}
    table, text = written(screen_errors.table, tmp_path, **told)
    cells = table.set_index(["experiment", "frames", "light"])["mse"]
    assert cells["hard", "training", "all"] == cells["hard", "validation", "all"] == 0.06
    assert cells["no_shadow", "room", "1"] == 0.1 and cells["five", "room", "all"] == 0.02
    assert table.set_index("experiment").loc["five", "null"].isna().all()
    assert set(table["null"].dropna()) == {"hard", "no_shadow"}
    assert set(table["mse_off_edges"].dropna()) == {0.01, 0.02, 0.05}
    assert "Shadow map" not in text and "vacuous" in text and "MSE off edges" in text
    table, text = written(screen_temporal.table, tmp_path, **told)
    flickers = table.set_index("label")["e_light"]
    assert flickers["Shadow map"] == 0.04 and flickers["Five"] == 0.02
    assert "| Shadow map" not in text and "| Five" in text


@pytest.mark.parametrize(
    ("scenes", "said"),
    [
        (["room"], "95 % over 16 frames of one scene, room; not valid for others"),
        (["a", "b"], "95 % over 16 frames in 2 scenes, a, b; not valid for others"),
        ([*"abcde"], "95 % over 5 scenes, by Student's t of their means"),
    ],
)
def test_intervals_say_what_they_are_over(scenes, said):
    assert describe_units(scenes, 16).startswith(said)
