import numpy as np
import pandas as pd
import pytest

from neural_shadows.errors import InputError
from neural_shadows.reports.claims import (
    CONTRADICTED,
    SUPPORTED,
    UNDECIDED,
    Data,
    judge,
    verdict_of,
    verdict_of_all,
    write_claims,
)

VIEWS = 24
# What views have in common is far larger than what methods differ by.
VIEW_LEVEL = np.random.default_rng(5).uniform(0.0, 0.5, VIEWS)


def metrics_of(values):
    """Tidy metrics of {(method, metric): (views,)}."""
    return pd.DataFrame(
        [
            (view, "surface", method, metric, float(value))
            for (method, metric), series in values.items()
            for view, value in enumerate(series)
        ],
        columns=["view", "view_set", "method", "metric", "value"],
    )


def noise(seed, scale=0.001, count=VIEWS):
    return np.random.default_rng(seed).normal(0, scale, count)


def one_scene(metric="lpips", views=VIEWS):
    values = {
        ("good", metric): VIEW_LEVEL + noise(1),
        ("bad", metric): VIEW_LEVEL + 0.01 + noise(2),
        ("alike", metric): VIEW_LEVEL + noise(3),
    }
    return metrics_of({key: series[:views] for key, series in values.items()})


def data_of(metrics=None, losses=None, times=None, scenes=None):
    metrics = metrics or {}
    return Data(metrics, scenes or dict.fromkeys(metrics, "dragon"), losses or {}, times or {}, 1)


def judged(data, **claim):
    claim = {"section": "4.3", "statement": "Something is so.", **claim}
    return judge({"it": claim}, data).iloc[0]


def better(pairs, metric="lpips", evaluations=("e",)):
    return {"kind": "better", "pairs": pairs, "metric": metric, "evaluations": list(evaluations)}


@pytest.mark.parametrize(
    ("interval", "bounds", "verdict"),
    [
        ((0.1, 0.2), (0, np.inf), SUPPORTED),
        ((-0.2, -0.1), (0, np.inf), CONTRADICTED),
        ((-0.1, 0.1), (0, np.inf), UNDECIDED),
        ((1.1, 1.2), (-np.inf, 1.25), SUPPORTED),
        ((1.2, 1.3), (-np.inf, 1.25), UNDECIDED),
        ((1.3, 1.4), (-np.inf, 1.25), CONTRADICTED),
        ((2.1, 2.2), (2, 3), SUPPORTED),
        ((1.1, 1.2), (2, 3), CONTRADICTED),
        ((0.0, 0.0), (0, np.inf), UNDECIDED),
        ((0.0, 0.1), (0, np.inf), UNDECIDED),
        ((-0.1, 0.0), (0, np.inf), UNDECIDED),
    ],
)
def test_verdict_of_an_interval(interval, bounds, verdict):
    assert verdict_of(*interval, *bounds) == verdict


@pytest.mark.parametrize(
    ("verdicts", "expected"),
    [
        ([SUPPORTED, SUPPORTED], SUPPORTED),
        ([SUPPORTED, UNDECIDED], UNDECIDED),
        ([SUPPORTED, CONTRADICTED, UNDECIDED], CONTRADICTED),
    ],
)
def test_verdict_of_several_comparisons(verdicts, expected):
    assert verdict_of_all(verdicts) == expected


def test_methods_of_one_scene_are_compared_view_by_view():
    data = data_of({"e": one_scene()})
    assert judged(data, **better([["good", "bad"]]))["verdict"] == SUPPORTED
    assert judged(data, **better([["bad", "good"]]))["verdict"] == CONTRADICTED
    assert judged(data, **better([["good", "alike"]]))["verdict"] == UNDECIDED
    # As independent samples the same numbers decide nothing: the views' spread hides them.
    halves = {
        "e": data.metrics["e"].query("method == 'good'"),
        "f": data.metrics["e"].query("method == 'bad'"),
    }
    apart = data_of(halves, scenes={"e": "dragon", "f": "fence"})
    claim = better([["good", "bad"]], evaluations=("e", "f"))
    assert judged(apart, **claim)["verdict"] == UNDECIDED
    together = data_of(halves)
    assert judged(together, **claim)["verdict"] == SUPPORTED


def test_higher_psnr_is_better():
    data = data_of({"e": one_scene("psnr")})
    assert judged(data, **better([["bad", "good"]], "psnr"))["verdict"] == SUPPORTED
    assert judged(data, **better([["good", "bad"]], "psnr"))["verdict"] == CONTRADICTED


def test_flip_takes_the_place_of_missing_lpips():
    row = judged(data_of({"e": one_scene("flip")}), **better([["good", "bad"]]))
    assert row["metric"] == "flip"
    assert row["verdict"] == SUPPORTED
    assert row["evidence"].startswith("FLIP for want of LPIPS: good")


def test_equal_methods_decide_nothing():
    metrics = metrics_of({(name, "lpips"): VIEW_LEVEL for name in ("one", "other")})
    row = judged(data_of({"e": metrics}), **better([["one", "other"]]))
    assert row["verdict"] == UNDECIDED


def test_methods_of_different_views_are_not_compared():
    metrics = one_scene().query("method != 'bad' or view != 7")
    with pytest.raises(InputError, match="good and of bad differ in their views .surface view 7"):
        judged(data_of({"e": metrics}), **better([["good", "bad"]]))


def test_few_views_decide_nothing():
    row = judged(data_of({"e": one_scene(views=3)}), **better([["good", "bad"]]))
    assert row["verdict"] == UNDECIDED
    assert "3 values are too few" in row["evidence"]


def test_evidence_gives_means_and_interval():
    row = judged(data_of({"e": one_scene()}), **better([["good", "bad"]]))
    assert row["evidence"].startswith("good 0.")
    low, high = map(float, row["evidence"].split("[")[1].split("]")[0].split(", "))
    gain = 0.01 + noise(2) - noise(1)
    half = 1.96 * gain.std() / np.sqrt(VIEWS)
    assert (low, high) == pytest.approx((gain.mean() - half, gain.mean() + half), abs=0.2 * half)


def test_more_compares_two_metrics_of_each_method():
    metrics = metrics_of(
        {
            ("a", "false_shadow"): 0.02 + noise(1),
            ("a", "light_leak"): 0.01 + noise(2),
            ("b", "false_shadow"): 0.01 + noise(3),
            ("b", "light_leak"): 0.02 + noise(4),
        }
    )
    claim = {"kind": "more", "evaluations": ["e"], "more": "false_shadow", "less": "light_leak"}
    assert judged(data_of({"e": metrics}), **claim, methods=["a"])["verdict"] == SUPPORTED
    assert judged(data_of({"e": metrics}), **claim, methods=["a", "b"])["verdict"] == CONTRADICTED


def test_loss_is_compared_at_its_end():
    steps = np.arange(1, 501)

    def curve(start, end, seed):
        # Loss falls to its end at nine tenths of the run and stays there.
        level = np.interp(steps, [1, 450], [start, end]) + noise(seed, count=500)
        return pd.DataFrame({"step": steps, "samples": steps, "learning_rate": 1, "loss": level})

    data = data_of(losses={"slow": curve(1, 0.1, 1), "fast": curve(0.5, 0.2, 2)})
    claim = {"kind": "lower_loss"}
    assert judged(data, **claim, pairs=[["slow", "fast"]])["verdict"] == SUPPORTED
    assert judged(data, **claim, pairs=[["fast", "slow"]])["verdict"] == CONTRADICTED


@pytest.mark.parametrize(
    ("bounds", "verdict"),
    [
        ({"at_most": 2.5}, SUPPORTED),
        ({"at_most": 1.5}, CONTRADICTED),
        ({"at_least": 1.5, "at_most": 2.5}, SUPPORTED),
        ({"at_least": 2.0}, UNDECIDED),
    ],
)
def test_frame_times_are_compared_as_a_ratio_of_medians(bounds, verdict):
    faster = 10 + noise(1, 0.1, 15)
    slower = 20 + noise(2, 0.3, 15)
    slower[3] = 400.0  # a disturbance, which a median does not see
    times = {
        "t": {
            "fence": {"methods": {"slower": {"ms": [1.0] * 15}}},
            "dragon": {"methods": {"slower": {"ms": slower}, "faster": {"ms": faster}}},
        }
    }
    row = judged(
        data_of(times=times),
        kind="frame_time",
        table="t",
        pairs=[["slower", "faster"]],
        **({"at_least": None, "at_most": None} | bounds),
    )
    assert row["verdict"] == verdict


def test_missing_values_are_named():
    with pytest.raises(InputError, match="no values of lpips of unknown in the evaluations e"):
        judged(data_of({"e": one_scene()}), **better([["good", "unknown"]]))


def write(tmp_path, metrics_csv):
    write_claims(
        tmp_path / "claims.csv",
        tmp_path / "claims.md",
        claims={
            "first": {
                "section": "4.3",
                "statement": "Good is better than bad.",
                **better([["good", "bad"]]),
            }
        },
        metrics={"e": [metrics_csv]},
        scenes={"e": "dragon"},
        losses={},
        frame_times={},
        scale="test",
        samples=20_480_000,
        seed=1,
    )


def test_claims_are_written_with_the_scale_that_the_thesis_had(tmp_path):
    metrics_csv = tmp_path / "metrics.csv"
    one_scene().to_csv(metrics_csv, index=False, lineterminator="\n")
    write(tmp_path, metrics_csv)
    row = pd.read_csv(tmp_path / "claims.csv").iloc[0]
    assert row["verdict"] == SUPPORTED
    assert (row["samples"], row["thesis_samples"]) == (20_480_000, 65_536_000_000)
    markdown = (tmp_path / "claims.md").read_text()
    assert "1 supported, 0 contradicted, 0 undecided of 1" in markdown
    assert "3,200 times as many" in markdown


def test_truncated_metrics_are_named(tmp_path):
    metrics_csv = tmp_path / "metrics.csv"
    text = one_scene().to_csv(index=False, lineterminator="\n")
    metrics_csv.write_text(text[:-4])
    with pytest.raises(
        InputError, match=r"metrics\.csv: not a whole file of metrics \(it is cut short\)"
    ):
        write(tmp_path, metrics_csv)
    assert not (tmp_path / "claims.csv").exists()
