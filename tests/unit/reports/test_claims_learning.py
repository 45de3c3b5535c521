from dataclasses import replace

import numpy as np
import pytest
from claim_samples import VIEWS, WORST, better, loss_curve, measured, points, scene, views

from neural_shadows.reports.claims.comparison import Comparison
from neural_shadows.reports.claims.gates import direction_of, judge, trend_of
from neural_shadows.reports.claims.learning import Learning, widened
from neural_shadows.reports.data import verdicts
from neural_shadows.reports.data.trained import THESIS_SAMPLES

SHARES = np.array([1 / 81, 1 / 27, 1 / 9, 1 / 3, 1])  # of the largest budget


def outcome_of(a, b, largest, *, seeds=3, noise=0.002, metric="lpips", as_loss=False):
    """Judge a claim on curves with errors by the share.

    `largest`: the largest budget as a share of the thesis's samples. Each training's error is off by
    a factor of its own.
    """
    rng = np.random.default_rng(7)
    budgets = [int(share * largest * THESIS_SAMPLES) for share in SHARES]
    curves = {name: points(name, budgets, seeds) for name in ("a", "b")}
    errors = {
        point["experiment"]: law(point["samples"] / budgets[-1]) * np.exp(rng.normal(0, noise))
        for name, law in (("a", a), ("b", b))
        for point in curves[name]
    }
    if as_loss:
        losses = {name: loss_curve(error) for name, error in errors.items()}
        claim = better(("a", "b"), metrics=["loss"], budget=0.1)
        return judge(claim, measured(curves=curves, losses=losses))
    if metric == "psnr":
        errors = {name: np.full(VIEWS, -10 * np.log10(error)) for name, error in errors.items()}
    methods = {name: {metric: views(e) if np.ndim(e) == 0 else e} for name, e in errors.items()}
    claim = better(("a", "b"), metrics=[metric], budget=0.1)
    frames = scene(methods, WORST | {metric: WORST.get(metric, 0.5)})
    return judge(claim, measured({"dragon": frames}, curves))


def power_law(floor, fall, exponent=0.5):
    return lambda share: floor + fall * share**-exponent


# Behind at the largest budget (0.05 against 0.045) and ahead at 20 times it (0.02 against 0.041).
AHEAD_LATER = power_law(0.0112, 0.0388), power_law(0.04, 0.005)


@pytest.mark.parametrize("as_loss", [False, True])
def test_a_licensed_extrapolation_decides(as_loss):
    outcome = outcome_of(*AHEAD_LATER, largest=0.05, as_loss=as_loss)
    assert outcome["verdict"] == "supported"
    assert "at the thesis's samples, extrapolated" in outcome["reason"]
    assert (outcome["direction"], outcome["trend"] > 0) == ("towards", True)
    assert "(20 times the largest budget, the hold-out tries 3 times)" in outcome["evidence"]
    at = float(outcome["evidence"].split("at the thesis's samples ")[1].split(" ")[0])
    assert at == pytest.approx(0.04 + 0.005 / 20**0.5 - 0.0112 - 0.0388 / 20**0.5, abs=0.002)
    ahead_no_more = outcome_of(*AHEAD_LATER[::-1], largest=0.05, as_loss=as_loss)
    assert (ahead_no_more["verdict"], ahead_no_more["direction"]) == ("contradicted", "away")


def test_a_trend_has_the_unit_of_its_metric():
    """Of a share in per cent, as the advantage beside it."""
    share, percent = (
        outcome_of(*AHEAD_LATER, largest=0.05, metric=name) for name in ("lpips", "shadow_error")
    )
    assert percent["trend"] == pytest.approx(100 * share["trend"])
    at = [
        float(outcome["evidence"].split("at the thesis's samples ")[1].split(" ")[0])
        for outcome in (share, percent)
    ]
    assert at[1] == pytest.approx(100 * at[0], rel=0.01)


def test_an_extrapolation_of_psnr_is_one_of_squared_errors():
    # A factor of two of the errors is 3.01 dB at all budgets.
    outcome = outcome_of(power_law(0, 1e-3), power_law(0, 2e-3), 0.05, metric="psnr")
    assert outcome["verdict"] == "supported"
    at = outcome["evidence"].split("at the thesis's samples ")[1].split(" ")[0]
    assert float(at) == pytest.approx(3.01, abs=0.05)
    assert outcome["trend"] == pytest.approx(0, abs=0.05)


def test_more_than_thirtyfold_is_not_licensed():
    outcome = outcome_of(*AHEAD_LATER, largest=0.02)
    assert outcome["verdict"] == verdicts.TOO_SMALL
    missing = (
        "2 % of the thesis's samples, 10 % are needed; an extrapolation needs 1/30: 2.2 billion"
    )
    assert missing in outcome["reason"]
    assert "no extrapolation: 50 times the largest budget" in outcome["reason"]
    assert outcome["reason"].endswith("moving towards the claim")
    assert "at the thesis's samples" not in outcome["evidence"]


def test_a_curve_that_bends_is_not_licensed():
    def bending(share):
        return 0.1 * share**-0.1 if share < 0.9 else 0.05

    outcome = outcome_of(bending, AHEAD_LATER[1], largest=0.05)
    assert outcome["verdict"] == verdicts.TOO_SMALL
    assert "no extrapolation: the hold-out is missed by" in outcome["reason"]


def test_one_seed_has_a_trend_without_an_interval():
    outcome = outcome_of(*AHEAD_LATER, largest=0.05, seeds=1)
    assert outcome["verdict"] == verdicts.TOO_SMALL
    assert outcome["reason"].startswith("1 seed of 2; ")
    assert np.isfinite(outcome["trend"]) and np.isnan(outcome["trend_low"])
    assert outcome["direction"] == ""


def test_a_gap_that_closes_only_since_both_errors_fall_moves_neither_way():
    outcome = outcome_of(power_law(0, 0.05), power_law(0, 0.04), largest=0.02, as_loss=True)
    assert outcome["trend_low"] > 0
    assert outcome["direction"] == "neither"
    assert outcome["reason"].endswith("moving neither towards the claim nor away")


def test_a_map_does_not_learn():
    curve = points("net", [int(s * 0.05 * THESIS_SAMPLES) for s in SHARES], 3)
    law, rng = AHEAD_LATER[0], np.random.default_rng(7)
    errors = [law(p["samples"] / curve[-1]["samples"]) * np.exp(rng.normal(0, 0.01)) for p in curve]
    methods = {p["experiment"]: {"lpips": views(e)} for p, e in zip(curve, errors)}
    methods["shadow_map_512"] = {"lpips": views(0.03)}
    data = measured({"dragon": scene(methods)}, {"net": curve})
    outcome = judge(better(("net", "shadow_map_512"), budget=0.1), data)
    assert outcome["verdict"] == "supported"
    at = float(outcome["evidence"].split("at the thesis's samples ")[1].split(" ")[0])
    assert at == pytest.approx(0.03 - law(20), abs=0.003)


def test_each_side_of_an_extrapolation_is_widened_apart():
    # 90 % of fits from 0.99 to 1.5 are 1.96 / 1.645 times as far at 95 %; views go 0.02 and 0.1.
    value, low, high, p = widened((1.0, 0.99, 1.5), (0.02, 0.1))
    assert (value, low) == pytest.approx((1.0, 1 - np.hypot(0.01 * 1.1916, 0.02)), abs=1e-4)
    assert high == pytest.approx(1 + np.hypot(0.5 * 1.1916, 0.1), abs=1e-4)
    # What 0 lies on the narrow side of is sure; on the wide side it is not.
    assert p < 1e-6
    *_, high, p = widened((-0.2, -0.25, 0.1), (0.0, 0.0))
    assert high > 0 and p > 0.05
    assert widened((0.0, 0.0, 0.0), (0.0, 0.0))[3] == 1.0


def test_a_direction_is_given_only_where_all_open_comparisons_move_alike():
    towards, away = (
        Learning(*[(1, 0.5, 1.5)] * 2, None, "", (9, 3)),
        Learning(*[(-1, -1.5, -0.5)] * 2, None, "", (9, 3)),
    )
    good = Comparison("lpips", "a", "a", "+1", True, 1.0, learning=away)
    bad = Comparison("lpips", "b", "b", "-1", False, 1.0, learning=towards)
    other = Comparison("psnr", "c", "c", "-1", False, 1.0, learning=away)
    assert direction_of([good, bad]) == "towards"
    assert direction_of([good, bad, other]) == ""
    assert direction_of([bad, replace(bad, learning=None)]) == ""
    assert direction_of([good]) == "away"
    assert trend_of([good, bad, other])["trend_of"] == "lpips of b"
