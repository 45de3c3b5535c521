import numpy as np
import pandas as pd
import pytest
from report_samples import row, write_metrics, write_record, written_table

from neural_shadows.reports import claims
from neural_shadows.reports.claims import CONTRADICTED, SUPPORTED, UNDECIDED, Data
from neural_shadows.reports.tables.quality import METRICS

VIEWS = 24
# What views have in common is far larger than what methods differ by.
VIEW_LEVEL = np.random.default_rng(5).uniform(0.0, 0.5, VIEWS)


def noise(seed, scale=0.001, count=VIEWS):
    return np.random.default_rng(seed).normal(0, scale, count)


def one_scene(metric="lpips", views=VIEWS):
    values = {
        ("good", metric): VIEW_LEVEL + noise(1),
        ("bad", metric): VIEW_LEVEL + 0.01 + noise(2),
        ("alike", metric): VIEW_LEVEL + noise(3),
    }
    return pd.DataFrame(values)[:views]


def better(*pairs, metric="lpips"):
    pairs = [[row(method) for method in pair] for pair in pairs]
    return {"kind": "better", "pairs": pairs, "metric": metric}


def judged(claim, metrics=None, losses=None, times=None, fence=None):
    claim = {"section": "4.3", "statement": "Something is so.", **claim}
    data = Data({"dragon": metrics, "fence": fence}, losses or {}, times or {}, seed=1)
    return claims.judge({"it": claim}, data).iloc[0]


@pytest.mark.parametrize(
    ("interval", "bounds", "verdict"),
    [
        ((0.1, 0.2), (0, np.inf), SUPPORTED),
        ((-0.2, -0.1), (0, np.inf), CONTRADICTED),
        ((-0.1, 0.1), (0, np.inf), UNDECIDED),
        ((0.0, 0.1), (0, np.inf), UNDECIDED),
        ((1.1, 1.2), (2, 3), CONTRADICTED),
    ],
)
def test_verdict_of_an_interval(interval, bounds, verdict):
    assert claims.verdict_of(*interval, *bounds) == verdict


def test_methods_of_one_scene_are_compared_view_by_view():
    found = judged(better(("good", "bad")), one_scene())
    low, high = map(float, found["evidence"].split("[")[1].split("]")[0].split(", "))
    gain = 0.01 + noise(2) - noise(1)
    half = 1.96 * gain.std() / np.sqrt(VIEWS)
    assert (low, high) == pytest.approx((gain.mean() - half, gain.mean() + half), abs=0.2 * half)
    # As independent samples the same numbers decide nothing: the views' spread hides them.
    apart = better(("good", "bad"))
    apart["pairs"][0][1]["scene"] = "fence"
    assert judged(apart, one_scene(), fence=one_scene())["verdict"] == UNDECIDED


@pytest.mark.parametrize(
    ("pairs", "verdict"),
    [
        ([("good", "bad")], SUPPORTED),
        ([("bad", "good")], CONTRADICTED),
        ([("good", "alike")], UNDECIDED),
        ([("good", "bad"), ("good", "alike")], UNDECIDED),
        ([("good", "bad"), ("good", "alike"), ("bad", "good")], CONTRADICTED),
    ],
)
def test_each_comparison_counts(pairs, verdict):
    assert judged(better(*pairs), one_scene())["verdict"] == verdict


def test_metrics_have_a_direction_and_flip_takes_the_place_of_missing_lpips():
    higher = better(("bad", "good"), metric="psnr")
    assert judged(higher, one_scene("psnr"))["verdict"] == SUPPORTED
    found = judged(better(("good", "bad")), one_scene("flip"))
    assert (found["metric"], found["verdict"]) == ("flip", SUPPORTED)


def test_larger_error_compares_two_errors_of_each_method():
    means = {"a": (0.02, 0.01), "b": (0.01, 0.02)}
    values = {
        (method, error): mean + noise(i)
        for method, pair in means.items()
        for i, (error, mean) in enumerate(zip(("false_shadow", "light_leak"), pair))
    }
    claim = {"kind": "larger_error", "more": "false_shadow", "less": "light_leak"}
    for methods, verdict in (("a", SUPPORTED), ("ab", CONTRADICTED)):
        asked = claim | {"methods": [row(method) for method in methods]}
        assert judged(asked, pd.DataFrame(values))["verdict"] == verdict


def test_loss_is_compared_at_its_end():
    # Loss falls to its end at nine tenths of the run and stays there.
    steps, spread = np.arange(500), noise(1, count=500)
    losses = {
        name: pd.DataFrame({"loss": np.interp(steps, [0, 449], ends) + spread})
        for name, ends in {"slow": (1, 0.1), "fast": (0.5, 0.2)}.items()
    }
    claim = {"kind": "lower_loss", "pairs": [[row("slow"), row("fast")]]}
    assert judged(claim, losses=losses)["verdict"] == SUPPORTED


@pytest.mark.parametrize(
    ("least", "most", "verdict"),
    [(None, 2.5, SUPPORTED), (None, 1.5, CONTRADICTED), (1.5, 2.5, SUPPORTED), (2, 3, UNDECIDED)],
)
def test_frame_times_are_compared_as_a_ratio_of_medians(least, most, verdict):
    slower = 20 + noise(2, 0.3, 15)
    slower[3] = 400.0  # a disturbance, which a median does not see
    methods = {"slower": {"ms": slower}, "faster": {"ms": 10 + noise(1, 0.1, 15)}}
    claim = {"kind": "frame_time", "table": "t", "pairs": [[row("slower"), row("faster")]]}
    claim |= {"at_least": least, "at_most": most}
    found = judged(claim, times={("t", "dragon"): {"methods": methods}})
    assert found["verdict"] == verdict


def test_claims_are_written_with_the_scale_that_the_thesis_had(tmp_path):
    loss_csv = tmp_path / "networks" / "good" / "loss.csv"
    loss_csv.parent.mkdir(parents=True)
    loss_csv.write_text("step,samples,learning_rate,loss\n1,9,0.1,0.5\n")
    means = {"good": dict.fromkeys(METRICS, 0.1), "bad": dict.fromkeys(METRICS, 0.2)}
    asked = {
        "quality": better(("good", "bad")),
        "loss": {"kind": "lower_loss", "pairs": [[row("good")] * 2]},  # of a single point
    }
    found, md = written_table(
        claims.write_claims,
        tmp_path,
        metrics=[write_metrics(tmp_path, means, views=VIEWS)],
        losses=[loss_csv],
        times=[write_record(tmp_path / "frame_times" / "t" / "dragon.json", {})],
        claims={name: {"section": "4", "statement": "So."} | c for name, c in asked.items()},
        samples=20_480_000,
    )
    assert found["verdict"].tolist() == [SUPPORTED, UNDECIDED]
    assert "1 values are too few" in found["evidence"][1]
    assert (found["samples"][0], found["thesis_samples"][0]) == (20_480_000, 65_536_000_000)
    text = md.read_text()
    assert "1 supported, 0 contradicted, 1 undecided of 2" in text
    assert "3,200 times as many" in text
