"""Tables of trained networks on frames, from made numbers; their figures."""

import numpy as np
import pytest
import report_samples as samples
from report_samples import PUBLISHED as THESIS_CSV

from neural_shadows.evaluation.answers import flicker_name, write_answers
from neural_shadows.evaluation.metric_files import write_metrics
from neural_shadows.reports.data.frame_means import describe_units
from neural_shadows.reports.data.soft_frames import describe_trainings
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
TRAINING = {
    **{"steps": 10, "crops": 2, "crop": 32, "learning_rate": 1e-3, "seed": 5},
    **{"optimiser": "adam", "perturbation": 3.0, "perturbation_from": 0.5},
}
VALIDATIONS = [{"step": step, "mse": [0.9 / step, 1.1 / step]} for step in (1, 4, 7)]
VALIDATIONS.append({"step": 10, "mse": [0.01, 0.03]})
RECORD = {
    **{"training": TRAINING, "perceptual": "squeeze", "died_at_step": None},
    **{"validations": VALIDATIONS, "validation_mse": [0.01, 0.03]},
}
LABELS = {"three": "3 levels", "five": "5 levels"}
KEY = {"part": "test_000", "frame": 0, "radius": 0, "scene": "plate_90"}


def frames(value, metric="mse", lights=(1, 2), **key):
    """Rows of four frames under two lights, of a value times each light's factor."""
    return [
        {**key, "frame": i, "radius": k, "metric": metric, "value": value * factor}
        for i in range(4)
        for k, factor in enumerate(lights)
    ]


@pytest.fixture
def made(tmp_path):
    """A function of a kind, rows by method, and changes of the trainings: its table and text."""

    def made(kind, rows, learned=(), labels=LABELS, **given):
        metrics, trainings = [], []
        for method, values in rows.items():
            metrics.append(tmp_path / f"{method}.csv")
            write_metrics(metrics[-1], [{**KEY, "method": method, **row} for row in values])
        for name, levels in {"three": 3, "five": 5}.items():
            if name in labels:
                record = RECORD | {"network": {"widths": [8] * levels}} | dict(learned)
                path = tmp_path / name / "training.json"
                trainings.append(samples.write_record(path, record))
        about = {"width": 8, "height": 4, "radii": [0, 0.25]}
        settings = {
            **{"soft_metrics": metrics, "null_metrics": [], "screen_trainings": trainings},
            "frames_json": samples.write_record(tmp_path / "frames.json", about),
            **{"labels": labels, "published_nsm_csv": PUBLISHED},
        }
        table, md = samples.written_table(kind.table, tmp_path, **settings | given)
        return table, md.read_text(encoding="utf-8")

    return made


def test_depths_stand_beside_what_is_printed(made):
    """Of the largest light alone, over the frames of each plate."""
    errors = {
        "three": {"plate_21": 0.01, "plate_90": 0.08},
        "five": {"plate_21": 0.02, "plate_90": 0.01},
    }
    rows = {
        name: [
            row
            for metric in ("mse", "mse_widest")
            for scene, value in by_scene.items()
            for row in frames(value, metric, scene=scene)
        ]
        for name, by_scene in errors.items()
    }
    columns = {"layers_3": "three", "layers_5": "five"}
    table, text = made(screen_depth, rows, columns=columns, published="nsm.1")
    cells = table.set_index(["row", "column"])
    assert cells["mse"].to_dict() == {
        **{("penumbra_21", "layers_3"): 0.02, ("penumbra_21", "layers_5"): 0.04},
        **{("penumbra_90", "layers_3"): 0.16, ("penumbra_90", "layers_5"): 0.02},
    }
    assert cells["mse_widest"].to_dict() == cells["mse"].to_dict()
    widest = cells.loc[("penumbra_90", "layers_3")]
    assert widest["printed_mse"] == 0.083 and widest["ratio"] == 8
    assert widest["mse_minus_printed"] == pytest.approx(0.077)
    assert cells["receptive_field"].tolist() == [24, 96, 24, 96]
    assert "| 90 px" in text and "8.0 / 1.0" in text and "table 1 of Datta" in text
    assert "3 levels 10,000 after 1, 2,500 after 4, 1,429 after 7, 200 after 10; 5" in text


def test_features_with_their_worth(made, tmp_path):
    shares = []
    for name, parts in {"three": {"ratio": 1.0}, "five": {"ratio": 0.9, "n": 0.1}}.items():
        found = {k: {"share": v, "sensitivity": v, "as_printed": 2 * v} for k, v in parts.items()}
        shares.append(samples.write_record(tmp_path / f"{name}.json", {"features": found}))
    table, text = made(
        screen_features,
        {
            "three": frames(0.02) + frames(9.0, scene="another"),  # which does not count
            "five": frames(0.01),
        },
        measured=["plate_90"],
        sensitivities=shares,
        columns={"features_2": "three", "extraction": "five"},
        published="nsm.s1",
    )
    assert table["error"].tolist() == [0.03, 0.015] and table["channels"].tolist() == [1, 4]
    assert table["printed_error"].tolist() == [0.00686, 0.00664]  # of the table and of the text
    assert table["share_n"].tolist()[1] == 0.1 and np.isnan(table["share_n"][0])
    assert "ratio 90.0, n 10.0" in text
    table_csv = tmp_path / "table.csv"
    text = samples.written_figure(screen_sensitivity.draw, tmp_path, table_csv=table_csv)
    assert "(n): 10.0 %" in text


@pytest.fixture
def steps(made, tmp_path):
    """A function of a whole frame's milliseconds by number format: the steps' table and text."""

    def steps(milliseconds, errors, published="nsm.steps"):
        run = {"device": "cpu", "threads": 2, "product_macs": 1e12, "parts": []}
        runs = [run | {"precision": name, "whole_ms": ms} for name, ms in milliseconds.items()]
        profile = {"width": 2048, "height": 1024, "runs": runs, "machine": {"cpu": "a CPU"}}
        profile |= {"repeats": 10, "warm_up": 3, "product_size": 2048}
        profile |= {"formats": ["float32", "bfloat16"]}
        profile |= {"levels": [{"weights": 2**18, "macs": 1e4}]}
        step = {"network": "trimmed", "experiment": "five"}
        names = {"trimmed": "float32", "trimmed_half": "bfloat16"}
        return made(
            screen_steps,
            {
                f"five_{name}": [{"metric": "mse", "value": value} for value in values]
                for name, values in errors.items()
            },
            labels={"five": "5 levels"},
            profiles=[samples.write_record(tmp_path / "trimmed.json", profile)],
            steps={name: step | {"precision": precision} for name, precision in names.items()},
            frames_json=None,
            measured=["plate_90"],
            published=published,
        )

    return steps


def test_steps(steps):
    given = {"float32": 400.0, "bfloat16": 100.0}, {"float32": [0.006], "bfloat16": [0.007]}
    table, text = steps(*given)
    assert table["runtime"].tolist() == [400, 100] and table["printed_runtime"].tolist() == [28, 17]
    assert table["size"].tolist() == [1, 0.5] and table["error"].tolist() == [0.006, 0.007]
    assert table["share"].tolist() == pytest.approx([2**21 * 1e4 / 0.4e12, 2**21 * 1e4 / 0.1e12])
    assert table["of_printed_size"].all() and " 6.67 |" in text
    table, text = steps(*given, published=None)
    assert table["printed_runtime"].isna().all() and "Printed" not in text and "400.0" in text


def test_steps_in_a_format_that_the_processor_lacks(steps):
    """Their cells are empty, and notes say why."""
    table, text = steps({"float32": 400.0}, {"float32": [0.006], "bfloat16": []})
    half = table.set_index("row").loc["trimmed_half"]
    assert half[["runtime", "share", "error", "run"]].isna().all() and half["size"] == 0.5
    assert table["runtime"][0] == 400 and table["error"][0] == 0.006
    assert "Not timed: bfloat16 on the CPU, which has no instructions" in text


def test_diverged_trainings_are_named():
    """Their numbers are those of a constant answer, and would be read as those of their form."""
    records = {"three": RECORD, "five": RECORD | {"died_at_step": 146}}
    alike, diverged = describe_trainings(records, LABELS)
    assert "3 levels, 5 levels." in alike and "perceptual term: squeeze" in alike
    assert "5 levels at step 146" in diverged and "3 levels" not in diverged


def test_flicker_by_what_moves(made):
    rows = [
        {"part": f"{kind}_000", "metric": metric, "value": value}
        for kind, factor in {"camera": 1, "light": 2}.items()
        for metric, value in {
            **{"instability": 0.2 * factor, "instability_taa": 0.1 * factor},
            **{"instability_recursive": 0.02 * factor, "mse_sequence_recursive": 0.04},
            **{"instability_reference": 0.05, "mse_sequence": 0.02, "mse_sequence_taa": 0.03},
            **{"mse_change": 0.001 * factor, "mse_change_off_edges": 0.0005 * factor},
        }.items()
    ]
    rows = [row | {"scene": "room"} for row in rows]
    rows += [row | {"scene": "other", "value": 3 * row["value"]} for row in rows]
    rows.append({"metric": "mse_edge", "value": 0.5})
    widths = enumerate((3, np.nan))  # of the point light, the first of two
    rows += [{"metric": "edge_width", "radius": k, "value": width} for k, width in widths]
    table, text = made(screen_temporal, {"five": rows}, labels={"five": "Five"})
    assert table["edge_width"].tolist() == pytest.approx([3, np.nan, np.nan], nan_ok=True)
    assert table["label"].tolist() == ["Five", "Five + TAA", "Five + recursive TAA"]
    # Means over both scenes, one with three times the values.
    assert table["e_light"].tolist() == pytest.approx([0.8, 0.4, 0.08])
    assert table["e_camera"].tolist() == pytest.approx([0.4, 0.2, 0.04])
    assert table["mse_sequence"].tolist() == pytest.approx([0.04, 0.06, 0.08])
    assert table["mse_change"][0] == pytest.approx(0.003) and table["mse_edge"][0] == 0.5
    assert table["mse_change_light"][0] == pytest.approx(0.004) and "are of room, other" in text


def test_what_was_learned_beside_what_was_not(made):
    """Errors of scene and light as they were made; sequences are of the middle light, 1 of two."""
    rows = frames(0.02, scene="room") + frames(0.04, scene="room_dragon")
    rows += [
        {"scene": scene, "radius": k, "metric": name, "value": width}
        for scene in ("room", "room_dragon")
        for k, width in enumerate((2, 12))
        for name in ("width", "width_reference")
    ]
    paths = {"scene": "room", "radius": 1, "metric": "mse_sequence", "value": 0.09}
    rows += [paths | {"part": f"{kind}_000"} for kind in ("camera", "light")]
    learned = {"scenes": ["room"], "radii": [0, 0.25]}
    learned |= {"train_mse": [0.01, 0.03], "validation_mse": [0.02, None]}
    table, text = made(screen_errors, {"five": rows}, learned, labels={"five": "Five"})
    cells = table.set_index(["frames", "light"])
    assert cells["mse"].dropna().to_dict() == {
        **{("training", "0"): 0.01, ("training", "1"): 0.03, ("training", "all"): 0.02},
        ("validation", "0"): 0.02,
        **{("room", "0"): 0.02, ("room", "1"): 0.04, ("room", "all"): 0.03},
        **{("room_dragon", "0"): 0.04, ("room_dragon", "1"): 0.08, ("room_dragon", "all"): 0.06},
        ("sequences", "1"): 0.09,
    }
    assert cells.loc[("room_dragon", "all"), "ratio"] == cells.loc[("sequences", "1"), "ratio"] == 3
    # Of the lights that were trained, without all of them together: 0.02 and 0.04 of 0.01 and 0.03.
    row = next(line for line in text.splitlines() if "| room " in line and "MSE ×" in line)
    assert f"{(2 + 4 / 3) / 2:.2f}" in row
    assert cells.loc[("room", "1"), "width"] == 12 and "exact width, px" in text
    assert "room_dragon (unseen)" in text and "room (unseen)" not in text


def test_lights_that_a_network_did_not_learn_have_no_training_error(made):
    learned = {"scenes": ["room"], "radii": [0, 0.5], "train_mse": [1, 1], "validation_mse": [1, 1]}
    rows = {"five": frames(0.02, scene="room")}
    table, text = made(screen_errors, rows, learned, labels={"five": "Five"})
    assert set(table["frames"]) == {"room"} and table["ratio"].isna().all()
    assert "× training" not in text.splitlines()[2]


def test_a_line_over_the_solids_before_the_light(made):
    """Errors of 0.01 a solid, of frames half of whose pixels behind something have two before them.

    A point light, of which they are the ninefold, has no part. A sequence's frames are no test frames.
    """
    values = {"mse_solids_1": 0.01, "mse_solids_2": 0.02, "mse_behind": 0.015, "solids_behind": 1.5}
    values |= {"mse": 0.01, "mse_per_solid": 0.01, "mse_solids_3": float("nan")}
    rows = [row for name, value in values.items() for row in frames(value, name, (9, 1))]
    rows += frames(0.1, "e", part="light_000")
    table, text = made(screen_solids, {"five": rows}, labels={"five": "Five"})
    assert table["mse"].tolist()[:2] == [0.01, 0.02] and np.isnan(table["mse"][2])
    assert table["line"].tolist() == pytest.approx([0.01, 0.02, 0.03])
    assert table["slope_low"].tolist() == pytest.approx([0.01] * 3)
    assert "[95 % over 4 frames of one scene" in text
    assert "3 and more" in text and "100.0 [100.0, 100.0]" in text


def test_maps_of_flicker_are_drawn(tmp_path):
    part = tmp_path / "room" / "light_000.json"
    image = np.zeros((4, 8))
    image[1, 2] = 0.5
    names = {flicker_name(part): image, flicker_name(part, exact=True): 0 * image}
    write_answers(tmp_path / "five.npz", names)
    files = {"sequences": [part], "soft_answers": [tmp_path / "five.npz"]}
    text = samples.written_figure(screen_flicker.draw, tmp_path, labels={"five": "Five"}, **files)
    assert "Five, light moves: 0.0157" in text


def test_what_learns_nothing_is_in_the_csv_alone(made):
    """On training frames and on those of validation, as measured there."""
    rows = {
        method: [
            *(frames(value, "mse", (1, 1), scene="room")),
            *(frames(value / 2, "mse_off_edges", (1, 1), scene="room")),
            *(
                {"metric": name, "part": "light_000", "value": value}
                for name in ("instability", "instability_reference")
            ),
        ]
        for method, value in {"five": 0.02, "hard": 0.04, "no_shadow": 0.1}.items()
    }
    learned = {"scenes": ["room"], "radii": [0, 0.25], "train_mse": [0.01] * 2}
    learned |= {"validation_mse": [0.02] * 2, "null_mse": {"hard_map": [0.05, 0.07]}}
    learned |= {"train_null_mse": {"hard_map": [0.01, 0.03]}}
    table, text = made(screen_errors, rows, learned, labels={"five": "Five"})
    cells = table.set_index(["experiment", "frames", "light"])["mse"]
    assert cells["hard", "training", "all"] == 0.02 and cells["hard", "validation", "all"] == 0.06
    # Twice the error of training is no overfitting of frames that are three times as hard.
    to_map = table.set_index(["experiment", "frames", "light"])["ratio_to_map"]
    assert to_map["five", "training", "all"] == 0.5 and to_map["five", "room", "all"] == 0.5
    assert to_map["five", "validation", "all"] == pytest.approx(1 / 3) and "× map" in text
    assert cells["no_shadow", "room", "1"] == 0.1 and cells["five", "room", "all"] == 0.02
    assert table.set_index("experiment").loc["five", "null"].isna().all()
    assert set(table["null"].dropna()) == {"hard", "no_shadow"}
    assert set(table["mse_off_edges"].dropna()) == {0.01, 0.02, 0.05}
    assert "Shadow map" not in text and "vacuous" in text and "MSE off edges" in text
    table, text = made(screen_temporal, rows, learned, labels={"five": "Five"})
    flickers = table.set_index("label")["e_light"]
    assert flickers["Shadow map"] == 0.04 and flickers["Five"] == 0.02
    # With one row of a null predictor, by which a claim finds its number.
    assert table[table["null"].notna()]["label"].tolist() == ["No shadow", "Shadow map"]
    listed, _ = made(screen_temporal, rows, learned, labels={"five": "Five", "hard": "Shadow map"})
    assert listed[listed["null"] == "hard"]["e_light"].tolist() == [0.04]
    assert listed[listed["null"].isna()]["label"].tolist()[3:5] == [
        "Shadow map",
        "Shadow map + TAA",
    ]


@pytest.mark.parametrize(
    ("scenes", "sample"),
    [
        (["room"], "95 % over 16 frames of one scene, room; not valid for others"),
        (["a", "b"], "95 % over 16 frames in 2 scenes, a, b; not valid for others"),
        ([*"abcde"], "95 % over 5 scenes, by Student's t of their means"),
    ],
)
def test_intervals_say_what_they_are_over(scenes, sample):
    assert describe_units(scenes, 16).startswith(sample)
