import numpy as np
import pandas as pd
import pytest
from report_samples import row, write_metrics, write_record, written_table

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


AT_LEAST_1 = {"at_least": 1, "at_most": None}


def metrics_of(values):
    """Tidy metrics of {(method, metric): (views,)}."""
    rows = [
        (view, "surface", *key, float(value))
        for key, series in values.items()
        for view, value in enumerate(series)
    ]
    return pd.DataFrame(rows, columns=["view", "view_set", "method", "metric", "value"])


def noise(seed, scale=0.001, count=VIEWS):
    return np.random.default_rng(seed).normal(0, scale, count)


def one_scene(metric="lpips", views=VIEWS):
    values = {
        ("good", metric): VIEW_LEVEL + noise(1),
        ("bad", metric): VIEW_LEVEL + 0.01 + noise(2),
        ("alike", metric): VIEW_LEVEL + noise(3),
    }
    return metrics_of({key: series[:views] for key, series in values.items()})


def better(*methods, metric="lpips", scenes=("dragon", "dragon")):
    pair = [row(method, scene=scene) for method, scene in zip(methods, scenes)]
    return {"kind": "better", "pairs": [pair], "metric": metric}


def judged(claim, metrics=None, losses=None, times=None):
    claim = {"section": "4.3", "statement": "Something is so.", **claim}
    metrics = metrics if isinstance(metrics, dict) else {"dragon": metrics}
    return judge({"it": claim}, Data(metrics, losses or {}, times or {}, seed=1)).iloc[0]


def test_verdict_of_an_interval():
    for interval, bounds, verdict in (
        ((0.1, 0.2), (0, np.inf), SUPPORTED),
        ((-0.2, -0.1), (0, np.inf), CONTRADICTED),
        ((-0.1, 0.1), (0, np.inf), UNDECIDED),
        ((0.0, 0.0), (0, np.inf), UNDECIDED),
        ((0.0, 0.1), (0, np.inf), UNDECIDED),
        ((1.2, 1.3), (-np.inf, 1.25), UNDECIDED),
        ((1.3, 1.4), (-np.inf, 1.25), CONTRADICTED),
        ((1.1, 1.2), (2, 3), CONTRADICTED),
    ):
        assert verdict_of(*interval, *bounds) == verdict, (interval, bounds)


def test_verdict_of_several_comparisons():
    assert verdict_of_all([SUPPORTED, SUPPORTED]) == SUPPORTED
    assert verdict_of_all([SUPPORTED, UNDECIDED]) == UNDECIDED
    assert verdict_of_all([SUPPORTED, CONTRADICTED, UNDECIDED]) == CONTRADICTED


def test_methods_of_one_scene_are_compared_view_by_view():
    metrics = one_scene()
    assert judged(better("good", "bad"), metrics)["verdict"] == SUPPORTED
    assert judged(better("bad", "good"), metrics)["verdict"] == CONTRADICTED
    assert judged(better("good", "alike"), metrics)["verdict"] == UNDECIDED
    higher = better("bad", "good", metric="psnr")
    assert judged(higher, one_scene("psnr"))["verdict"] == SUPPORTED
    # As independent samples the same numbers decide nothing: the views' spread hides them.
    apart = better("good", "bad", scenes=("dragon", "fence"))
    assert judged(apart, {"dragon": metrics, "fence": metrics})["verdict"] == UNDECIDED


def test_flip_takes_the_place_of_missing_lpips():
    found = judged(better("good", "bad"), one_scene("flip"))
    assert (found["metric"], found["verdict"]) == ("flip", SUPPORTED)
    assert found["evidence"].startswith("FLIP for want of LPIPS: good")


def test_missing_values_are_named():
    with pytest.raises(InputError, match="no values of lpips of unknown"):
        judged(better("good", "unknown"), one_scene())
    metrics = one_scene().query("method != 'bad' or view != 7")
    with pytest.raises(InputError, match="differ in their views .surface view 7"):
        judged(better("good", "bad"), metrics)


def test_few_views_decide_nothing():
    found = judged(better("good", "bad"), one_scene(views=3))
    assert found["verdict"] == UNDECIDED
    assert "3 values are too few" in found["evidence"]


def test_evidence_gives_means_and_interval():
    evidence = judged(better("good", "bad"), one_scene())["evidence"]
    assert evidence.startswith("good 0.")
    low, high = map(float, evidence.split("[")[1].split("]")[0].split(", "))
    gain = 0.01 + noise(2) - noise(1)
    half = 1.96 * gain.std() / np.sqrt(VIEWS)
    assert (low, high) == pytest.approx((gain.mean() - half, gain.mean() + half), abs=0.2 * half)


def test_larger_error_compares_two_errors_of_each_method():
    metrics = metrics_of(
        {
            ("a", "false_shadow"): 0.02 + noise(1),
            ("a", "light_leak"): 0.01 + noise(2),
            ("b", "false_shadow"): 0.01 + noise(3),
            ("b", "light_leak"): 0.02 + noise(4),
        }
    )
    claim = {"kind": "larger_error", "more": "false_shadow", "less": "light_leak"}
    assert judged(claim | {"methods": [row("a")]}, metrics)["verdict"] == SUPPORTED
    assert judged(claim | {"methods": [row("a"), row("b")]}, metrics)["verdict"] == CONTRADICTED


def test_loss_is_compared_at_its_end():
    steps = np.arange(1, 501)

    def curve(start, end, seed):
        # Loss falls to its end at nine tenths of the run and stays there.
        level = np.interp(steps, [1, 450], [start, end]) + noise(seed, count=500)
        return pd.DataFrame({"step": steps, "samples": steps, "learning_rate": 1, "loss": level})

    losses = {"slow": curve(1, 0.1, 1), "fast": curve(0.5, 0.2, 2)}
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
    found, md = written_table(
        write_claims,
        tmp_path,
        metrics=write_metrics(tmp_path, "dragon", one_scene()),
        losses=[loss_csv],
        times=[write_record(tmp_path / "frame_times" / "t" / "dragon.json", times)],
        claims={
            name: {"section": "4.3", "statement": "Good is better than bad.", **claim}
            for name, claim in {
                "quality": better("good", "bad"),
                "loss": {"kind": "lower_loss", "pairs": [[row("good")] * 2]},
                "time": {"kind": "frame_time", "table": "t", "pairs": [pair], **AT_LEAST_1},
            }.items()
        },
        samples=20_480_000,
    )
    assert found["verdict"].tolist() == [SUPPORTED, UNDECIDED, UNDECIDED]
    assert (found["samples"][0], found["thesis_samples"][0]) == (20_480_000, 65_536_000_000)
    text = md.read_text()
    assert "1 supported, 0 contradicted, 2 undecided of 3" in text
    assert "3,200 times as many" in text
    assert "Meshes: dragon wyrm, fence fence; seed 1." in text
