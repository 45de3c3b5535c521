import itertools

import pytest
import report_samples as samples

from neural_shadows.reports.tables.frame_curves import table as make_table

AWAY = (-0.01, 0.0, 0.01)  # relative, of the seeds' errors


def test_curves_over_frames_beside_the_base(tmp_path):
    """A power law of two lights, one of them not trained for, from three seeds."""
    points, paths = [], []
    for steps, (frames, seed) in itertools.product(
        (600, 2400), itertools.product((1, 4, 7), range(3))
    ):
        name = f"net_{frames}_frames_{steps}_steps_seed_{seed}"
        points.append({"experiment": name, "steps": steps, "seed": seed, "frames": frames})
        points[-1]["samples"] = 12 * frames
        error = (0.004 if steps == 600 else 0.002) * frames**-0.5 * (1 + AWAY[seed])
        record = {
            **{"training": {"lights": [1]}, "died_at_step": None},
            **{"validation_mse": [9.0, error], "train_mse": [9.0, error / 2]},
            **{"null_mse": {"no_shadow": [9.0, 0.1], "hard_map": [9.0, 0.01]}},
            **{"train_null_mse": {"no_shadow": [9.0, 0.1], "hard_map": [9.0, 0.005]}},
        }
        paths.append(samples.write_record(tmp_path / name / "training.json", record))
    rows = [
        {"method": "net", "experiment": "net", "scene": "layouts", "label": f"{n}", "steps": n}
        for n in (600, 2400)
    ]
    table, md = samples.written_table(
        make_table, tmp_path, trainings=paths, rows=rows, curves={"net": points}
    )
    assert table["samples"].tolist() == [12, 48, 84, 336] * 2
    cells = table.set_index(["steps", "samples"])
    assert cells.loc[(600, 84), "mean"] == pytest.approx(0.004 / 7**0.5, rel=1e-4)
    assert cells.loc[(2400, 48), "train_mean"] == pytest.approx(0.0005, rel=1e-4)
    assert (table["base"] == 0.01).all() and (table["no_shadow"] == 0.1).all()
    last = cells.loc[(600, 84)]
    assert last["train_base"] == 0.005 and last["error"] == pytest.approx(0, abs=0.01)
    further = cells.loc[(600, 336), "predicted"]
    assert further == pytest.approx(0.004 / 28**0.5, rel=0.02)
    row = samples.cells_of(md, 0)
    assert row["12 frames"].startswith("40.0 ± 0.4") and row["base"] == "100.0"
    assert row["on training frames"] == "7.6 (50.0)" and row["no shadow"] == "1000.0"
    assert row["at 4 × the frames"].startswith("7.6 [") and row["missed by"] in ("+0.0 %", "-0.0 %")
