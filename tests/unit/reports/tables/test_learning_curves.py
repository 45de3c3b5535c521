import numpy as np
import pandas as pd
import pytest
import report_samples as samples

from neural_shadows.reports.data.quality import METRICS
from neural_shadows.reports.tables.learning_curves import table as make_table

ROWS = [
    samples.row("dragon", "Poisson", published="poisson_quadtree"),
    samples.row("dragon_uniform", "Uniform", published="uniform"),
]
BUDGETS = (1_000_000, 2_000_000, 4_000_000, 8_000_000)
SEEDS = 3
AWAY = np.array([-0.01, 0.0, 0.01])  # relative, of the seeds' errors


def loss_at(name, budget):
    """Of `dragon` a power law; the other falls faster at the end, so that it misses."""
    faster = 0.8 if name == "dragon_uniform" and budget == BUDGETS[-1] else 1.0
    return 0.32 * (budget / BUDGETS[0]) ** -0.25 * faster


def views_of(method, squared_error):
    """Four views of a method: squared errors with this mean, and half of them as LPIPS."""
    by_view = squared_error * np.array([0.5, 0.5, 1.5, 1.5])
    values = dict.fromkeys(METRICS, by_view) | {
        "lpips": by_view / 2,
        "psnr": -10 * np.log10(by_view),
        "ssim": 1 - by_view,
    }
    return [
        (i // 2, ("shadow", "surface")[i % 2], method, metric, value)
        for metric, each in values.items()
        for i, value in enumerate(each)
    ]


@pytest.fixture
def written(tmp_path):
    """The table of two methods; each error is a tenth of the loss, and no shadow's 0.1."""

    def written(seeds=SEEDS, **mesh):
        curves, losses, trainings, views = {}, [], [], views_of("no_shadow", 0.1)
        for name in ("dragon", "dragon_uniform"):
            points = [(budget, seed) for budget in BUDGETS for seed in range(seeds)]
            curves[name] = []
            for budget, seed in points:
                key = f"{name}_{budget // 64}_steps_seed_{seed}"
                curves[name].append({"experiment": key, "samples": budget, "seed": seed})
                loss = loss_at(name, budget) * (1 + AWAY[seed])
                views += views_of(key, loss / 10)
                folder = tmp_path / "networks" / key
                record = samples.TRAINING | {"name": key, "no_shadow_loss": 0.5}
                trainings.append(samples.write_record(folder / "training.json", record))
                losses.append(folder / "loss.csv")
                # Nine tenths of the curve are not its end.
                each = [9.0] * 9 + [loss]
                lines = [f"{i},{i},0.1,{value}\n" for i, value in enumerate(each)]
                losses[-1].write_text("step,samples,learning_rate,loss\n" + "".join(lines))
        metrics_csv = tmp_path / "dragon" / "metrics.csv"
        metrics_csv.parent.mkdir(exist_ok=True)
        columns = ["frame", "part", "method", "metric", "value"]
        values = pd.DataFrame(views, columns=columns).assign(scene="dragon", radius=0)
        values.to_csv(metrics_csv, index=False)
        table, md = samples.written_table(
            make_table,
            tmp_path,
            metrics=[metrics_csv],
            losses=losses,
            trainings=trainings,
            meshes=[samples.write_mesh(tmp_path, **mesh)],
            published="4.1",
            rows=ROWS,
            curves=curves,
        )
        return table.set_index(["method", "metric", "samples"]), md

    return written


def test_budgets_and_what_they_predict_of_the_largest(written):
    table, md = written(thesis_mesh=True)
    assert table.index.get_level_values("metric").unique().tolist() == [
        *("loss", "lpips", "psnr", "ssim")
    ]
    loss = table.loc["Poisson", "loss"]
    assert loss["mean"].dropna().tolist() == pytest.approx([loss_at("", n) for n in BUDGETS], 1e-5)
    assert loss["spread"].iloc[0] == pytest.approx(0.0032, rel=1e-4)
    first = [float(value) for value in loss["by_seed"].iloc[0].split()]
    assert first == pytest.approx([0.3168, 0.32, 0.3232])
    assert loss["exponent"].dropna().tolist() == pytest.approx([0.25] * 3, rel=1e-4)
    # The same law for each metric, in its own unit.
    assert (table["no_shadow"].loc["Poisson", "loss"] == 0.5).all()
    last = table.xs(BUDGETS[-1], level="samples")
    at_end = 0.32 / 8**0.25
    for metric, value, null in (
        ("loss", at_end, 0.5),
        ("lpips", at_end / 20, 0.05),
        ("psnr", -10 * np.log10(at_end / 10), 10.0),
        ("ssim", 1 - at_end / 10, 0.9),
    ):
        row = last.loc["Poisson", metric]
        found = row[["mean", "predicted", "no_shadow"]].astype(float)
        assert found.tolist() == pytest.approx([value, value, null], rel=1e-3)
        assert row["predicted_low"] < row["predicted"] < row["predicted_high"]
        assert row["error"] == pytest.approx(0, abs=0.01)
        # What falls by a further fifth is missed by a quarter, and the interval says so.
        assert last.loc["Uniform", metric]["error"] == pytest.approx(0.25, abs=0.01)
    cells = samples.cells_of(md, 2)
    assert cells["metric"] == "PSNR ↑"
    assert cells["1 M samples"] == "14.95 ± 0.04" and cells["exponent"] == "0.25 → 0.25"
    assert samples.cells_of(md, 4)["missed by"] == "+25.0 %"


def test_nothing_is_said_beyond_what_the_budgets_license(written):
    table, md = written(thesis_mesh=True)
    beyond = table.xs(65_536_000_000, level="samples")
    assert beyond[["mean", "predicted"]].isna().all(axis=None)
    why = "8,192 times the largest budget, 30 at most"
    assert (beyond["unlicensed"].loc["Poisson"] == why).all()
    missed = beyond.loc["Uniform", "loss"]["unlicensed"]
    assert missed == f"the hold-out is missed by +25.0 %, outside its interval; {why}"
    assert beyond["kind"].unique().tolist() == ["extrapolated"]
    assert beyond["step"].tolist() == pytest.approx([8192] * 8)
    assert samples.cells_of(md, 0)["at the thesis's samples"] == why
    # What the thesis prints stands at its budget.
    assert beyond.loc["Poisson", "psnr"]["thesis"] == 27.21
    assert np.isnan(beyond.loc["Poisson", "loss"]["thesis"])
    assert samples.cells_of(md, 2)["thesis"] == "27.21"


def test_within_thirtyfold_the_end_is_an_interval(written, monkeypatch):
    module = "neural_shadows.reports.tables.learning_curves"
    monkeypatch.setattr(f"{module}.THESIS_SAMPLES", 16 * BUDGETS[-1])
    table, md = written()
    beyond = table.xs(16 * BUDGETS[-1], level="samples")
    found = beyond.loc["Poisson", "psnr"]
    assert found["predicted"] == pytest.approx(-10 * np.log10(0.032 / 128**0.25), rel=1e-3)
    assert found["predicted_low"] < found["predicted"] < found["predicted_high"]
    assert samples.cells_of(md, 2)["at the thesis's samples"].startswith("20.2")
    missed = "the hold-out is missed by +25.0 %, outside its interval"
    assert beyond.loc["Uniform", "loss"]["unlicensed"] == missed
    # It did not measure this mesh.
    assert beyond["thesis"].isna().all()


def test_one_seed_has_neither_spread_nor_interval(written):
    table, md = written(seeds=1)
    last = table.loc["Poisson", "loss"].loc[BUDGETS[-1]]
    assert np.isnan(last[["spread", "predicted_low", "predicted_high"]].astype(float)).all()
    assert last["predicted"] == pytest.approx(last["mean"], rel=1e-4)
    cells = samples.cells_of(md, 0)
    assert cells["at the thesis's samples"] == "one seed gives no uncertainty of the fit"
    assert "[" not in cells["largest, as predicted"]
