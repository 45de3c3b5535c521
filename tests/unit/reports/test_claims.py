import numpy as np
import pandas as pd
import pytest
from report_samples import all_metrics, row, write_metrics, write_record, written_table
from report_samples import metrics_of as spread_metrics

from neural_shadows.reports.claims import (
    CONTRADICTED,
    SUPPORTED,
    UNDECIDED,
    Data,
    judge,
    verdict_of,
    write_claims,
)

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


def better(*methods, metric="lpips", scenes=("dragon", "dragon")):
    pair = [row(method, scene=scene) for method, scene in zip(methods, scenes)]
    return {"kind": "better", "pairs": [pair], "metric": metric}


def judged(claim, metrics=None, losses=None, times=None):
    claim = {"section": "4.3", "statement": "Something is so.", **claim}
    metrics = metrics if isinstance(metrics, dict) else {"dragon": metrics}
    return judge({"it": claim}, Data(metrics, losses or {}, times or {}, seed=1)).iloc[0]


@pytest.mark.parametrize(
    ("interval", "bounds", "verdict"),
    [
        ((0.1, 0.2), (0, np.inf), SUPPORTED),
        ((-0.2, -0.1), (0, np.inf), CONTRADICTED),
        ((-0.1, 0.1), (0, np.inf), UNDECIDED),
        ((0.0, 0.1), (0, np.inf), UNDECIDED),
        ((1.2, 1.3), (-np.inf, 1.25), UNDECIDED),
        ((1.1, 1.2), (2, 3), CONTRADICTED),
    ],
)
def test_verdict_of_an_interval(interval, bounds, verdict):
    assert verdict_of(*interval, *bounds) == verdict


def test_methods_of_one_scene_are_compared_view_by_view():
    metrics = one_scene()
    found = judged(better("good", "bad"), metrics)
    assert found["verdict"] == SUPPORTED
    low, high = map(float, found["evidence"].split("[")[1].split("]")[0].split(", "))
    gain = 0.01 + noise(2) - noise(1)
    half = 1.96 * gain.std() / np.sqrt(VIEWS)
    assert (low, high) == pytest.approx((gain.mean() - half, gain.mean() + half), abs=0.2 * half)

    assert judged(better("bad", "good"), metrics)["verdict"] == CONTRADICTED
    assert judged(better("good", "alike"), metrics)["verdict"] == UNDECIDED
    higher = better("bad", "good", metric="psnr")
    assert judged(higher, one_scene("psnr"))["verdict"] == SUPPORTED
    # As independent samples the same numbers decide nothing: the views' spread hides them.
    apart = better("good", "bad", scenes=("dragon", "fence"))
    assert judged(apart, {"dragon": metrics, "fence": metrics})["verdict"] == UNDECIDED


def test_each_comparison_counts():
    claim = better("good", "bad")
    claim["pairs"] += better("good", "alike")["pairs"]
    assert judged(claim, one_scene())["verdict"] == UNDECIDED
    claim["pairs"] += better("bad", "good")["pairs"]
    assert judged(claim, one_scene())["verdict"] == CONTRADICTED


def test_flip_takes_the_place_of_missing_lpips():
    found = judged(better("good", "bad"), one_scene("flip"))
    assert (found["metric"], found["verdict"]) == ("flip", SUPPORTED)
    assert found["evidence"].startswith("FLIP, as LPIPS is not available: good 0.")


def test_few_views_decide_nothing():
    found = judged(better("good", "bad"), one_scene(views=3))
    assert found["verdict"] == UNDECIDED
    assert "3 values are too few" in found["evidence"]


def test_larger_error_compares_two_errors_of_each_method():
    values = {
        ("a", "false_shadow"): 0.02 + noise(1),
        ("a", "light_leak"): 0.01 + noise(2),
        ("b", "false_shadow"): 0.01 + noise(3),
        ("b", "light_leak"): 0.02 + noise(4),
    }
    claim = {"kind": "larger_error", "more": "false_shadow", "less": "light_leak"}
    for methods, verdict in (("a", SUPPORTED), ("ab", CONTRADICTED)):
        asked = claim | {"methods": [row(method) for method in methods]}
        assert judged(asked, pd.DataFrame(values))["verdict"] == verdict


def test_loss_is_compared_at_its_end():
    # Loss falls to its end at nine tenths of the run and stays there.
    losses = {
        name: pd.DataFrame(
            {"loss": np.interp(np.arange(500), [0, 449], ends) + noise(1, count=500)}
        )
        for name, ends in {"slow": (1, 0.1), "fast": (0.5, 0.2)}.items()
    }
    for pair, verdict in ((("slow", "fast"), SUPPORTED), (("fast", "slow"), CONTRADICTED)):
        claim = {"kind": "lower_loss", "pairs": [[row(name) for name in pair]]}
        assert judged(claim, losses=losses)["verdict"] == verdict


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
    slower = 20 + noise(2, 0.3, 15)
    slower[3] = 400.0  # a disturbance, which a median does not see
    methods = {"slower": {"ms": slower}, "faster": {"ms": 10 + noise(1, 0.1, 15)}}
    pair = [row("slower"), row("faster")]
    claim = {"kind": "frame_time", "table": "t", "pairs": [pair], "at_least": None, "at_most": None}
    found = judged(claim | bounds, times={("t", "dragon"): {"methods": methods}})
    assert found["verdict"] == verdict


def test_claims_are_written_with_the_scale_that_the_thesis_had(tmp_path):
    loss_csv = tmp_path / "networks" / "good" / "loss.csv"
    loss_csv.parent.mkdir(parents=True)
    loss_csv.write_text("step,samples,learning_rate,loss\n1,9,0.1,0.5\n")
    times = {"methods": {"good": {"ms": [1]}, "bad": {"ms": [2]}}}
    pair = [row("good"), row("bad")]
    quality = spread_metrics({"good": all_metrics(0.1), "bad": all_metrics(0.2)}, views=VIEWS)
    limits = {"at_least": 1, "at_most": None}
    claims = {
        "quality": better("good", "bad"),
        "loss": {"kind": "lower_loss", "pairs": [[row("good")] * 2]},
        "time": {"kind": "frame_time", "table": "t", "pairs": [pair], **limits},
    }
    said = {"section": "4.3", "statement": "Good is better than bad."}
    found, md = written_table(
        write_claims,
        tmp_path,
        metrics=write_metrics(tmp_path, "dragon", quality),
        losses=[loss_csv],
        times=[write_record(tmp_path / "frame_times" / "t" / "dragon.json", times)],
        claims={name: said | claim for name, claim in claims.items()},
        samples=20_480_000,
    )
    assert found["verdict"].tolist() == [SUPPORTED, UNDECIDED, UNDECIDED]
    assert (found["samples"][0], found["thesis_samples"][0]) == (20_480_000, 65_536_000_000)
    text = md.read_text()
    assert "1 supported, 0 contradicted, 2 undecided of 3" in text
    assert "3,200 times as many" in text
    assert "Meshes: dragon wyrm, fence fence; seed 1." in text
