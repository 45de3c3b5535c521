import numpy as np
import pandas as pd
import pytest
from claim_samples import (
    INDEX,
    VIEW_LEVEL,
    VIEWS,
    better,
    measured,
    pairs,
    points,
    record,
    scene,
    verdict,
    views,
)
from report_samples import row

from neural_shadows.metrics.pooled_psnr import pooled_psnr
from neural_shadows.reports import verdicts
from neural_shadows.reports.claims.better import comparisons
from neural_shadows.reports.claims.gates import KINDS, judge
from neural_shadows.reports.claims.measured import THESIS_SAMPLES

BUILT = {"trainings": dict.fromkeys(("good", "bad"), record(training=None))}


def advantage(comparison):
    """The advantage and the ends of its interval as printed."""
    value, low, high = comparison.numbers.replace("[", "").replace("]", "").split(" ")
    return float(value), float(low.strip(",")), float(high)


def test_methods_of_one_scene_are_compared_view_by_view():
    good, bad = views(0.1, 0.002, 1), views(0.11, 0.002, 2)
    found = scene({"good": {"lpips": good}, "bad": {"lpips": bad}})
    (one,) = comparisons(better(("good", "bad")), measured({"dragon": found}, **BUILT))
    value, low, high = advantage(one)
    gain = pd.Series(bad - good, INDEX)
    within = (gain - gain.groupby("view_set").transform("mean")).std()
    half = 1.96 * within / np.sqrt(VIEWS)
    assert (value, low, high) == pytest.approx((0.01, 0.01 - half, 0.01 + half), abs=0.2 * half)
    # As independent samples the same numbers decide nothing: the views' spread hides them.
    assert VIEW_LEVEL.std() > 7 * gain.std()
    scenes = {"dragon": found, "fence": found}
    claim = better(("good", "bad"), scenes={"bad": "fence"})
    assert verdict(claim, measured(scenes, **BUILT)) == verdicts.UNDECIDED


def test_psnr_is_pooled_so_that_identical_frames_do_not_drive_it():
    bad = np.full(VIEWS, 30.0)
    good = np.where(np.arange(VIEWS) < 4, 100.0, 29.0)  # its mean is 40.8 dB
    found = scene({"good": {"psnr": good}, "bad": {"psnr": bad}})
    claim = better(("good", "bad"), metrics=["psnr"])
    (one,) = comparisons(claim, measured({"dragon": found}, **BUILT))
    expected = pooled_psnr(good) - 30
    assert advantage(one)[0] == pytest.approx(expected, abs=0.005)
    assert expected < 0 < good.mean() - 30
    assert one.text == "PSNR of good 29.8 dB against bad 30 dB"


@pytest.mark.parametrize(
    ("metric", "good", "bad"), [("lpips", 0.1, 0.2), ("psnr", 30, 20), ("ssim", 0.9, 0.8)]
)
def test_metrics_have_a_direction(metric, good, bad):
    found = scene({"good": {metric: good}, "bad": {metric: bad}})
    data = measured({"dragon": found}, **BUILT)
    for pair, expected in ((("good", "bad"), "supported"), (("bad", "good"), "contradicted")):
        assert verdict(better(pair, metrics=[metric]), data) == expected


def test_flip_takes_the_place_of_missing_lpips():
    found = scene({"good": {"flip": 0.1}, "bad": {"flip": 0.2}}, null={"flip": 0.3})
    found = judge(better(("good", "bad")), measured({"dragon": found}, **BUILT))
    assert (found["metric"], found["verdict"]) == ("flip", "supported")


def test_few_views_decide_nothing():
    found = scene({"good": {"lpips": 0.1}, "bad": {"lpips": 0.2}})[:9]
    found = judge(better(("good", "bad")), measured({"dragon": found}, **BUILT))
    assert found["verdict"] == verdicts.UNDECIDED
    assert "9 views are too few" in found["evidence"]


def noisy(seeds, spread, gap, rng):
    """Two networks whose trainings differ far more than views do: LPIPS `gap` apart in truth."""
    curves = {name: points(name, [THESIS_SAMPLES], seeds) for name in ("a", "b")}
    methods = {
        point["experiment"]: {"lpips": mean + rng.normal(0, spread) + rng.normal(0, 0.001, VIEWS)}
        for name, mean in (("a", 0.1), ("b", 0.1 + gap))
        for point in curves[name]
    }
    return measured({"dragon": scene(methods)}, curves)


def test_what_seeds_alone_explain_is_undecided():
    # In each of these data the interval over views alone would decide; see `two_way_interval`.
    rng = np.random.default_rng(3)
    found = [verdict(better(("a", "b")), noisy(3, 0.01, 0.0, rng)) for _ in range(8)]
    assert found.count("undecided") >= 7
    assert verdict(better(("a", "b")), noisy(3, 0.01, 0.15, rng)) == "supported"


def test_trainings_are_compared_at_the_largest_budget_and_by_the_seeds_that_both_have():
    budgets = [1000, 2000, 4000]
    curves = {"a": points("a", budgets[:2], 3), "b": points("b", budgets[1:], 2)}
    values = {"a_0": 0.2, "a_1": 0.1, "b_0": 0.15, "b_1": 0.05}
    methods = {
        point["experiment"]: {"lpips": values[point["experiment"][:3]]}
        for some in curves.values()
        for point in some
    }
    (one,) = comparisons(better(("a", "b")), measured({"dragon": scene(methods)}, curves))
    assert (one.samples, one.seeds) == (2000, 2)
    assert one.text == "LPIPS of a 0.1 against b 0.15"


def test_a_bias_found_on_held_out_views_is_that_of_each_training():
    curve = points("net", [THESIS_SAMPLES], 2)
    methods = {f"{point['experiment']}_biased": {"lpips": 0.1} for point in curve}
    methods["shadow_map_256"] = {"lpips": 0.2}
    claim = better(("net_biased", "shadow_map_256"))
    assert claim["pairs"][0][0]["experiment"] == "net"
    assert verdict(claim, measured({"dragon": scene(methods)}, {"net": curve})) == "supported"


def test_networks_that_share_no_budget_are_compared_as_they_are():
    trainings = {"a": record(1000), "b": record(5000, seed=7)}
    found = scene({"a": {"lpips": 0.1}, "b": {"lpips": 0.2}})
    (one,) = comparisons(better(("a", "b")), measured({"dragon": found}, trainings=trainings))
    assert (one.samples, one.seeds, one.supports) == (1000, 1, True)


@pytest.mark.parametrize("spread", [0.01, 0.03])
def test_losses_of_three_seeds_are_wrong_about_nothing_in_one_of_twenty(spread):
    rng = np.random.default_rng(1)
    curves = {name: points(name, [THESIS_SAMPLES], 3) for name in ("a", "b")}
    claim = {"kind": "lower_loss", "pairs": pairs(("a", "b"))}
    decided = 0
    for _ in range(400):
        ends = {p["experiment"]: rng.normal(0.2, spread) for some in curves.values() for p in some}
        found = {run: pd.DataFrame({"loss": [end] * 10}) for run, end in ends.items()}
        decided += verdict(claim, measured(curves=curves, losses=found)) != "undecided"
    assert 8 <= decided <= 32  # 20 expected, 4.4 their standard deviation


def timed(devices=("cpu", "cpu"), frames=15):
    rng = np.random.default_rng(2)
    own = 20 + rng.normal(0, 0.3, frames), 10 + rng.normal(0, 0.1, frames)
    own[0][3] = 400.0  # a disturbance, which a median does not see
    methods = {
        name: {"own_ms": list(ms), "ms": list(ms + 100), "device": device}
        for name, ms, device in zip(("slower", "faster"), own, devices)
    }
    times = {("t", "dragon"): {"methods": methods}}
    return measured(trainings=dict.fromkeys(methods, record()), times=times)


@pytest.mark.parametrize(
    ("least", "most", "expected"),
    [
        (None, 2.5, "supported"),
        (None, 1.5, "contradicted"),
        (3, None, "contradicted"),
        (1.5, 2.5, "supported"),
        (2, 3, "undecided"),
    ],
)
def test_own_times_are_compared_as_ratios_of_frames(least, most, expected):
    claim = {"kind": "frame_time", "table": "t", "pairs": pairs(("slower", "faster"))}
    claim |= {"at_least": least, "at_most": most}
    found = judge(claim, timed())
    assert found["verdict"] == expected
    assert found["evidence"].startswith("own time of slower 20.1 ms (frame 120 ms) against ")


@pytest.mark.parametrize(
    ("devices", "needed", "reason"),
    [
        (("cuda", "cpu"), None, "one device are needed: slower on cuda, faster on cpu"),
        (("cpu", "cpu"), "cuda", "cuda are needed: slower on cpu, faster on cpu"),
        (("cuda", "cuda"), "cuda", ""),
    ],
)
def test_times_of_another_class_of_device_are_not_comparable(devices, needed, reason):
    claim = {"kind": "frame_time", "table": "t", "pairs": pairs(("slower", "faster"))}
    claim |= {"at_least": 1, "at_most": None, "needs": {"device": needed}}
    found = judge(claim, timed(devices))
    assert (found["verdict"] == verdicts.NOT_COMPARABLE) == bool(reason)
    assert found["reason"].endswith(reason)


def test_few_frames_decide_nothing():
    claim = {"kind": "frame_time", "table": "t", "pairs": pairs(("slower", "faster"))}
    found = judge({**claim, "at_least": 1, "at_most": None}, timed(frames=5))
    assert found["verdict"] == verdicts.UNDECIDED
    assert "5 frames are too few" in found["evidence"]


@pytest.mark.parametrize(
    ("false", "leak", "expected"),
    [(40, 15, "supported"), (10, 30, "contradicted"), (20, 20, "undecided")],
)
def test_violations_are_judged_by_what_each_costs_and_not_by_how_many_there_are(
    false, leak, expected
):
    # Ten times as many violations of the upper bound: there is more light that leaks in all.
    rng = np.random.default_rng(4)
    counts = {
        "lower_violations": np.full(VIEWS, 100.0),
        "false_shadow_of_lower": rng.permutation(false + np.arange(VIEWS) % 3 - 1.0),
        "upper_violations": np.full(VIEWS, 1000.0),
        "light_leak_of_upper": 10 * rng.permutation(leak + np.arange(VIEWS) % 3 - 1.0),
    }
    good = {"lpips": 0.1, "psnr": 30.0, "ssim": 0.9}
    data = measured({"dragon": scene({"net": good | counts})}, trainings={"net": record()})
    found = judge({"kind": "violations", "methods": [row("net")]}, data)
    assert found["verdict"] == expected
    assert f"false shadow at {false} % of 2,400 violations of the lower bound" in found["evidence"]
    assert f"light leak at {leak} % of 24,000 of the upper" in found["evidence"]


def test_violations_of_a_network_that_draws_no_shadow_say_nothing():
    nothing = {"lower_violations": 0.0, "false_shadow_of_lower": 0.0}
    some = {"upper_violations": 9.0, "light_leak_of_upper": 9.0}
    counts = {name: np.full(VIEWS, count) for name, count in (nothing | some).items()}
    data = measured({"dragon": scene({"net": counts})}, trainings={"net": record()})
    (one,) = KINDS["violations"]({"methods": [row("net")]}, data)
    assert (one.supports, one.evidence) == (False, "net: the lower bound is never violated")


# The thesis against its own tables. 4.6 has 64 neurons worst on the landscape.
PRINTED = {
    "wider is worse": (
        {
            "table": "4.6",
            "pairs": [["landscape_64", "landscape_128"], ["landscape_128", "landscape_256"]],
        },
        ["lpips"],
        "contradicted",
    ),
    "fence better than 128": (
        {"table": "4.4", "pairs": [["network", "shadow_map_128"]]},
        ["lpips", "psnr", "ssim"],
        "contradicted",
    ),
    "axis better than 512": (
        {"table": "4.5", "pairs": [["network_single_axis", "shadow_map_512"]]},
        ["lpips", "psnr", "ssim"],
        "contradicted",
    ),
    "comparable to 512": (
        {"table": "4.3", "row": "network", "equivalent_to": 512},
        ["lpips", "psnr"],
        "contradicted",
    ),
    "30 better than 20 frequencies": (
        {"table": "4.2", "pairs": [["frequencies_30", "frequencies_20"]]},
        ["lpips", "psnr", "ssim"],
        "supported",
    ),
    "the same trained twice": (
        {"table": "4.2", "pairs": [["frequencies_10", "frequencies_10"]]},
        ["lpips"],
        "undecided",
    ),
    "between 256 and 512": (
        {"table": "4.3", "row": "network", "equivalent_to": 256},
        ["psnr"],
        "supported",
    ),
}


@pytest.mark.parametrize(("about", "metrics", "expected"), PRINTED.values(), ids=PRINTED)
def test_the_thesis_is_judged_by_its_own_tables(about, metrics, expected):
    found = judge({"kind": "printed", "metrics": metrics, **about}, measured())
    assert found["verdict"] == expected
    assert np.isnan([found["seeds"], found["budget_fraction"]]).all()


def test_the_thesis_is_worth_a_map_of_386_texels_by_lpips_and_of_191_by_psnr():
    claim = {"kind": "printed", "table": "4.3", "row": "network", "equivalent_to": 512}
    found = judge({**claim, "metrics": ["lpips", "psnr"]}, measured())["evidence"]
    assert "LPIPS of Our method 0.0379, as a map of 386²" in found
    assert "PSNR of Our method 27.39, as a map of 191²" in found
