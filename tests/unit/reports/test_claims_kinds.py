import numpy as np
import pandas as pd
import pytest
from claim_samples import (
    INDEX,
    VIEW_LEVEL,
    VIEWS,
    better,
    loss_curve,
    measured,
    pairs,
    points,
    record,
    scene,
    verdict,
    views,
    violated,
)
from report_samples import row

from neural_shadows.metrics.intervals import t_interval
from neural_shadows.metrics.pooled_psnr import mse_of, psnr_of
from neural_shadows.reports.claims import losses
from neural_shadows.reports.claims.gates import judge
from neural_shadows.reports.claims.kinds import violations
from neural_shadows.reports.claims.kinds.violations import COUNTS
from neural_shadows.reports.claims.views import comparisons
from neural_shadows.reports.data import verdicts
from neural_shadows.reports.data.trained import THESIS_SAMPLES

BUILT = ("good", "bad")


def advantage(comparison):
    """The advantage and the ends of its interval as printed."""
    value, low, high = comparison.number.replace("[", "").replace("]", "").split(" ")
    return float(value), float(low.strip(",")), float(high)


def test_methods_of_one_scene_are_compared_view_by_view():
    good, bad = views(0.1, 0.002, 1), views(0.11, 0.002, 2)
    frames = scene({"good": {"lpips": good}, "bad": {"lpips": bad}})
    (comparison,) = comparisons(better(("good", "bad"), built=BUILT), measured({"dragon": frames}))
    value, low, high = advantage(comparison)
    gain = pd.Series(bad - good, INDEX)
    within = (gain - gain.groupby("view_set").transform("mean")).std()
    half = 1.96 * within / np.sqrt(VIEWS)
    assert (value, low, high) == pytest.approx((0.01, 0.01 - half, 0.01 + half), abs=0.2 * half)
    # As independent samples the same numbers decide nothing: the views' spread hides them.
    assert VIEW_LEVEL.std() > 7 * gain.std()
    scenes = {"dragon": frames, "fence": frames}
    claim = better(("good", "bad"), scenes={"bad": "fence"}, built=BUILT)
    assert verdict(claim, measured(scenes)) == verdicts.UNDECIDED


def test_psnr_is_pooled_so_that_identical_frames_do_not_drive_it():
    bad = np.full(VIEWS, 30.0)
    good = np.where(np.arange(VIEWS) < 4, 100.0, 29.0)  # its mean is 40.8 dB
    frames = scene({"good": {"psnr": good}, "bad": {"psnr": bad}})
    claim = better(("good", "bad"), metrics=["psnr"], built=BUILT)
    (comparison,) = comparisons(claim, measured({"dragon": frames}))
    expected = psnr_of(mse_of(good).mean()) - 30
    assert advantage(comparison)[0] == pytest.approx(expected, abs=0.005)
    assert expected < 0 < good.mean() - 30
    assert comparison.text == "PSNR of good 29.8 dB against bad 30 dB"


@pytest.mark.parametrize(
    ("metric", "good", "bad"), [("lpips", 0.1, 0.2), ("psnr", 30, 20), ("ssim", 0.9, 0.8)]
)
def test_metrics_have_a_direction(metric, good, bad):
    frames = scene({"good": {metric: good}, "bad": {metric: bad}})
    data = measured({"dragon": frames})
    for pair, expected in ((("good", "bad"), "supported"), (("bad", "good"), "contradicted")):
        assert verdict(better(pair, metrics=[metric], built=BUILT), data) == expected


def test_flip_takes_the_place_of_missing_lpips():
    frames = scene({"good": {"flip": 0.1}, "bad": {"flip": 0.2}}, null={"flip": 0.3})
    frames = frames.drop(columns="lpips", level=1)
    outcome = judge(better(("good", "bad"), built=BUILT), measured({"dragon": frames}))
    assert (outcome["metric"], outcome["verdict"]) == ("flip", "supported")


@pytest.mark.parametrize(
    ("gaps", "expected"), [((0.01, 0.05, 0.09), "undecided"), ((0.04, 0.05, 0.06), "supported")]
)
def test_three_seeds_decide_as_students_t_does(gaps, expected):
    # Resampled seeds, or views alone, would decide both: no draw of the first has a mean below 0.01.
    curves = {name: points(name, [THESIS_SAMPLES], 3) for name in ("a", "b")}
    alike = views(0.1)
    methods = {f"a_0_{seed}": {"lpips": alike} for seed in range(3)}
    methods |= {f"b_0_{seed}": {"lpips": alike + gap} for seed, gap in enumerate(gaps)}
    data = measured({"dragon": scene(methods)}, curves)
    (comparison,) = comparisons(better(("a", "b")), data)
    assert advantage(comparison) == pytest.approx(t_interval(gaps)[:3], abs=0.1 * np.ptp(gaps))
    assert verdict(better(("a", "b")), data) == expected


def test_trainings_are_compared_at_the_largest_budget_and_by_the_seeds_that_both_have():
    budgets = [1000, 2000, 4000]
    curves = {"a": points("a", budgets[:2], 3), "b": points("b", budgets[1:], 2)}
    values = {"a_0": 0.2, "a_1": 0.1, "b_0": 0.15, "b_1": 0.05}
    methods = {
        point["experiment"]: {"lpips": values[point["experiment"][:3]]}
        for curve in curves.values()
        for point in curve
    }
    (comparison,) = comparisons(better(("a", "b")), measured({"dragon": scene(methods)}, curves))
    assert (comparison.samples, comparison.seeds) == (2000, 2)
    assert comparison.text == "LPIPS of a 0.1 against b 0.15"


def test_a_bias_found_on_held_out_views_is_that_of_each_training():
    curve = points("net", [THESIS_SAMPLES], 2)
    methods = {f"{point['experiment']}_biased": {"lpips": 0.1} for point in curve}
    methods["shadow_map_256"] = {"lpips": 0.2}
    claim = better(("net_biased", "shadow_map_256"))
    assert claim["rows"][0][0]["experiment"] == "net"
    assert verdict(claim, measured({"dragon": scene(methods)}, {"net": curve})) == "supported"


@pytest.mark.parametrize(
    ("other", "why"),
    [
        (record(5000), "trained on 1,000 and 5,000 samples"),
        (record(1000, seed=7), "trained from no common seed"),
    ],
)
@pytest.mark.parametrize("metric", ["lpips", "loss"])
def test_networks_that_share_no_budget_are_not_compared(metric, other, why):
    trainings = {"a": record(1000), "b": other}
    scenes = {"dragon": scene({"a": {"lpips": 0.1}, "b": {"lpips": 0.2}})}
    ends = {"a": loss_curve(0.1), "b": loss_curve(0.2)}
    data = measured(scenes, trainings=trainings, losses=ends)
    outcome = judge(better(("a", "b"), metrics=[metric]), data)
    assert (outcome["verdict"], outcome["reason"]) == ("not comparable", f"a against b: {why}")


def test_a_training_that_died_early_was_one_of_its_whole_length():
    trainings = {"a": record(5000), "b": record(5000, died_at_step=1) | {"samples": 1000}}
    data = measured(losses={"a": loss_curve(0.1), "b": loss_curve(0.2)}, trainings=trainings)
    (comparison,) = losses.comparisons(better(("a", "b")), data)
    assert (comparison.samples, comparison.text) == (5000, "loss of a 0.1 against b 0.5")


def timed(devices=("cpu", "cpu"), frames=15, needed=None, **changes):
    """The outcome of a claim on times of about 20 and 10 ms."""
    rng = np.random.default_rng(2)
    own = 20 + rng.normal(0, 0.3, frames), 10 + rng.normal(0, 0.1, frames)
    own[0][3] = 400.0  # a disturbance, which a median does not see
    methods = {
        name: {"own_ms": list(ms), "ms": list(ms + 100), "device": device}
        for name, ms, device in zip(("slower", "faster"), own, devices)
    }
    times = {("t", "dragon"): {"methods": methods}}
    claim = {"kind": "frame_time", "table": "t", "rows": pairs(("slower", "faster"))}
    claim |= {"at_least": None, "at_most": None, "overhead_ms": 0.0, "needs": {"device": needed}}
    return judge(claim | changes, measured(trainings=dict.fromkeys(methods, record()), times=times))


@pytest.mark.parametrize(
    ("changes", "verdict"),
    [
        ({"at_most": 2.5}, "supported"),
        ({"at_most": 1.5}, "contradicted"),
        ({"at_least": 3}, "contradicted"),
        ({"at_least": 1.5, "at_most": 2.5}, "supported"),
        ({"at_least": 2, "at_most": 3}, "undecided"),
        ({"at_least": 1, "devices": ("cuda", "cuda"), "needed": "cuda"}, "supported"),
        ({"at_least": 1, "devices": ("cuda", "cpu")}, verdicts.NOT_COMPARABLE),
        ({"at_least": 1, "needed": "cuda"}, verdicts.NOT_COMPARABLE),
    ],
)
def test_own_times_are_compared_as_ratios_of_frames(changes, verdict):
    outcome = timed(**changes)
    assert outcome["verdict"] == verdict
    assert (outcome["number_of"], outcome["number"][:7]) == ("own milliseconds", "ratio 2")
    assert outcome["evidence"].startswith("own time of slower 20.1 ms (frame 120 ms) against ")


def test_what_a_frame_takes_beside_the_method_is_added_to_both():
    outcome = timed(at_most=1.3, overhead_ms=30)
    assert outcome["verdict"] == "supported"
    numbers = outcome["evidence"].split("ratio ")[1]
    assert float(numbers.split(" ")[0]) == pytest.approx(1.25, rel=0.02)
    assert ", with 30 ms beside the method (at most 1.3)" in numbers


def counted(false, leak, count=VIEWS):
    """Violations by view, seen at so many of 100 points."""
    frames = scene({"net": violated(false, leak)})[:count]
    return measured({"dragon": frames}, trainings={"net": record()})


@pytest.mark.parametrize(
    ("false", "leak", "expected"),
    [(40, 15, "supported"), (10, 30, "contradicted"), (20, 20, "undecided")],
)
def test_violations_are_judged_by_what_each_costs_where_it_can_be_seen(false, leak, expected):
    # Of all violations of the upper bound a tenth is in shadow, of the lower a half is lit: as
    # shares of all, 20 would be more than 20 of the other.
    outcome = judge({"kind": "violations", "rows": [[row("net")]]}, counted(false, leak))
    assert outcome["verdict"] == expected
    lower = f"false shadow at {false} % of the 2,400 points that are lit, of 4,800 with a violated"
    upper = f"light leak at {leak} % of the 12,000 in shadow, of 120,000 with a violated upper one"
    assert lower in outcome["evidence"] and upper in outcome["evidence"]
    assert ("of one training" in outcome["reason"]) and outcome["seeds"] == 1


def test_what_violations_of_random_depths_cost_as_well_is_no_support():
    data = measured(
        {"dragon": scene({"net": violated(40, 15, of_random=(90, 70))})},
        trainings={"net": record()},
    )
    outcome = judge({"kind": "violations", "rows": [[row("net")]]}, data)
    assert outcome["verdict"] == "vacuous" and "random depths" in outcome["reason"]


def test_violations_are_those_of_the_largest_budget():
    half, whole = THESIS_SAMPLES // 2, THESIS_SAMPLES
    curve = points("net", [half, whole], 2)
    costs = {half: (10, 30), whole: (40, 15)}
    methods = {point["experiment"]: violated(*costs[point["samples"]]) for point in curve}
    data = measured({"dragon": scene(methods)}, {"net": curve})
    assert verdict({"kind": "violations", "rows": [[row("net")]]}, data) == "supported"


def test_few_views_or_frames_decide_nothing():
    frames = scene({"good": {"lpips": 0.1}, "bad": {"lpips": 0.2}})[:9]
    outcomes = [
        judge(better(("good", "bad"), built=BUILT), measured({"dragon": frames})),
        judge({"kind": "violations", "rows": [[row("net")]]}, counted(40, 15, count=9)),
        timed(frames=5, at_least=1),
    ]
    assert {outcome["verdict"] for outcome in outcomes} == {verdicts.TOO_SMALL}
    reasons = [outcome["reason"] for outcome in outcomes]
    assert reasons == ["9 views are too few: it takes 10"] * 2 + [
        "5 frames are too few: it takes 6"
    ]


def test_violations_of_a_network_that_draws_no_shadow_decide_nothing():
    counts = dict.fromkeys(COUNTS, np.zeros(VIEWS)) | {"lower_violations": np.ones(VIEWS)}
    data = measured({"dragon": scene({"net": counts})}, trainings={"net": record()})
    (comparison,) = violations.comparisons({"rows": [[row("net")]]}, data)
    assert (comparison.supports, comparison.evidence) == (
        False,
        "net: the lower bound is violated at no lit point",
    )
