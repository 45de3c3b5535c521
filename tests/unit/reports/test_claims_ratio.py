"""Claims on ratios of tables' numbers, on synthetic tables."""

import pandas as pd
import pytest
from claim_samples import measured

from neural_shadows.reports.claims.gates import judge
from neural_shadows.reports.data import verdicts

STEPS = pd.DataFrame(
    {
        **{"row": ["original", "trimmed"], "size": [26.0, 2.5], "runtime": [100.0, 28.0]},
        "of_printed_size": True,
    }
)
LEARNED = {
    **{"validation_mse": [0.01, 0.02], "null_mse": {"hard_map": [0.02, 0.05]}},
    "died_at_step": None,
}


def judged(ratio, trainings=None, steps=STEPS, again=(), **changes):
    ratio = {"table": "steps", "of": {"row": "original"}, "to": {"row": "trimmed"}, **ratio}
    ratio = {"at_least": None, "at_most": None, "per": None, "unlearned": None} | ratio
    others = {f"steps_{number}": table for number, table in enumerate(again)}
    claim = {"kind": "ratio", "ratios": [ratio], "networks": [], "needs": {}, **changes}
    claim["again"] = {"steps": [*others]}
    data = measured(tables={"steps": steps, **others}, screen_trainings=trainings or {})
    return judge(claim, data)


@pytest.mark.parametrize(
    ("ratio", "verdict"),
    [
        ({"column": "size", "at_least": 10}, verdicts.SUPPORTED),
        ({"column": "size", "at_most": 10}, verdicts.CONTRADICTED),
        ({"column": "size", "at_least": 10, "to": None}, verdicts.SUPPORTED),  # all others
        ({"column": "size", "at_least": 10, "to": {"row": "other"}}, verdicts.TOO_SMALL),
        ({"column": "weights", "at_least": 10}, verdicts.TOO_SMALL),
    ],
)
def test_numbers_are_within_bounds(ratio, verdict):
    outcome = judged(ratio)
    assert outcome["verdict"] == verdict
    if ratio["column"] == "size" and verdict != verdicts.TOO_SMALL:
        assert "ratio 10.4" in outcome["evidence"]


@pytest.mark.parametrize(
    ("sizes", "verdict", "number"),
    [
        ((10, 10.5, 11), verdicts.SUPPORTED, "ratio 10.5 [9.32, 11.8] over 3 seeds"),
        ((2, 2.1, 2.2), verdicts.CONTRADICTED, "ratio 2.1 ["),
        ((2, 10, 40), verdicts.UNDECIDED, "ratio 9.28 ["),
        ((10, 10.5), verdicts.TOO_SMALL, "2 seeds of 3"),
    ],
)
def test_tables_of_other_seeds_decide_by_student_s_t(sizes, verdict, number):
    steps, *others = (
        pd.DataFrame({"row": ["original", "trimmed"], "size": [size, 1.0]}) for size in sizes
    )
    changes = {"networks": ["nsm"], "needs": {"seeds": 3}}
    ratio = {"column": "size", "at_least": 5}
    outcome = judged(ratio, {"nsm": LEARNED}, steps, others, **changes)
    assert outcome["verdict"] == verdict
    assert number in f"{outcome['number']} {outcome['reason']}"


def test_a_number_over_the_mean_of_others():
    steps = pd.DataFrame({"row": ["a", "b", "c"], "size": [3.0, 1.0, 5.0]})
    ratio = {"column": "size", "of": {"row": "a"}, "to": [{"row": "b"}, {"row": "c"}]}
    outcome = judged(ratio | {"at_least": 0.99}, steps=steps)
    assert outcome["verdict"] == verdicts.SUPPORTED and outcome["number"] == "ratio 1"
    assert "a 3 over the mean of b and c 3" in outcome["evidence"]
    ratio["to"].append({"row": "d"})
    assert judged(ratio | {"at_least": 0.99}, steps=steps)["verdict"] == verdicts.TOO_SMALL


def test_a_number_over_a_given_one():
    size = {"column": "size", "of": {"row": "trimmed"}}
    outcome = judged(size | {"to": 5.0, "at_most": 1})
    assert outcome["verdict"] == verdicts.SUPPORTED and outcome["number"] == "ratio 0.5"
    assert "size of trimmed 2.5 over 5 (steps)" in outcome["evidence"]
    assert judged(size | {"to": 2.4, "at_most": 1})["verdict"] == verdicts.CONTRADICTED


def test_nothing_at_all_is_within_an_upper_bound():
    steps = pd.DataFrame({"row": ["original"], "size": [0.0]})
    outcome = judged({"column": "size", "to": 0.02, "at_most": 1}, steps=steps)
    assert outcome["verdict"] == verdicts.SUPPORTED and outcome["number"] == "ratio 0"


def test_numbers_are_first_divided_by_another_column():
    """A fourfold fall beside a twofold one."""
    flicker = {"row": ["original", "trimmed"], "light": [0.8, 0.2], "camera": [0.2, 0.1]}
    ratio = {"column": "light", "per": "camera", "at_least": 1}
    outcome = judged(ratio, steps=pd.DataFrame(flicker))
    assert outcome["verdict"] == verdicts.SUPPORTED and outcome["number"] == "ratio 2"
    assert "light per camera of original 4 over trimmed 2" in outcome["evidence"]
    flicker["camera"] = [0.8, 0.1]
    assert judged(ratio, steps=pd.DataFrame(flicker))["verdict"] == verdicts.CONTRADICTED


@pytest.mark.parametrize(
    ("net", "verdict"), [("squeeze", verdicts.SUPPORTED), ("none", verdicts.TOO_SMALL)]
)
def test_what_a_perceptual_loss_does_needs_one(net, verdict):
    trainings = {"plain": LEARNED | {"perceptual": net}, "l1": LEARNED | {"perceptual": "none"}}
    changes = {"networks": ["plain", "l1"], "needs": {"trunk": True}}
    outcome = judged({"column": "size", "at_least": 1}, trainings, **changes)
    assert outcome["verdict"] == verdict
    assert ("pretrained trunk" in outcome["reason"]) == (net == "none")


def test_times_may_have_to_be_of_a_gpu():
    ratio = {"column": "runtime", "of": {"row": "trimmed"}, "to": 30.0, "at_most": 1}
    needs = {"needs": {"device": "cuda"}}
    outcome = judged(ratio, steps=STEPS.assign(device="cpu"), **needs)
    assert outcome["verdict"] == verdicts.NOT_COMPARABLE and "cuda" in outcome["reason"]
    outcome = judged(ratio, steps=STEPS.assign(device="cuda"), **needs)
    assert outcome["verdict"] == verdicts.SUPPORTED


def test_times_are_of_frames_of_the_paper_s_size():
    ratio = {"column": "runtime", "at_least": 3.5}
    assert judged(ratio)["verdict"] == verdicts.SUPPORTED
    other = judged(ratio, steps=STEPS.assign(of_printed_size=False))
    assert other["verdict"] == verdicts.NOT_COMPARABLE


def test_what_networks_measure_needs_seeds_and_that_they_learned():
    changes = {"networks": ["nsm"], "needs": {"seeds": 3}}
    ratio = {"column": "size", "at_most": 1}
    outcome = judged(ratio, {"nsm": LEARNED}, **changes)
    assert outcome["verdict"] == verdicts.TOO_SMALL and "1 seed of 3" in outcome["reason"]
    worse = LEARNED | {"validation_mse": [0.03, 0.05]}
    outcome = judged(ratio, {"nsm": worse}, **changes)
    assert outcome["verdict"] == verdicts.NOT_LEARNED and "hard_map 350" in outcome["reason"]
    outcome = judged(ratio, {"nsm": LEARNED | {"died_at_step": 4000}}, **changes)
    assert (
        outcome["verdict"] == verdicts.NOT_LEARNED
        and "nsm: died at step 4,000" in outcome["reason"]
    )
    # Of a network of the second light alone the first does not count.
    alone = {"validation_mse": [9.0, 0.02], "training": {"lights": [1]}}
    outcome = judged(ratio, {"nsm": LEARNED | alone}, **changes)
    assert outcome["verdict"] == verdicts.TOO_SMALL


def of_nulls(**nulls):
    """Errors of networks and nulls on learned and unseen frames."""
    numbers = {"mine": (0.01, 0.012), "other": (0.02, 0.02)} | nulls
    rows = [
        {"label": name, "null": name if name in nulls else None, "frames": frames, "mse": value}
        for name, pair in numbers.items()
        for frames, value in zip(("learned", "unseen"), pair)
    ]
    return pd.DataFrame(rows)


CARRIES = {
    "of": {"label": "mine", "frames": "unseen"},
    "to": {"label": "mine", "frames": "learned"},
}
CARRIES |= {"column": "mse", "at_most": 1.5}
BEATS = {"of": {"label": "other", "frames": "unseen"}, "to": {"label": "mine", "frames": "unseen"}}
BEATS |= {"column": "mse", "at_least": 1}


@pytest.mark.parametrize(
    ("ratio", "nulls", "verdict"),
    [
        (CARRIES, {"hard": (0.04, 0.03)}, verdicts.VACUOUS),  # a map carries over as well
        (CARRIES, {"hard": (0.02, 0.04)}, verdicts.SUPPORTED),
        (BEATS, {"no_shadow": (0.09, 0.015)}, verdicts.VACUOUS),
        (BEATS, {"no_shadow": (0.09, 0.09)}, verdicts.SUPPORTED),
        (BEATS, {"no_shadow": (0.09, 0.02)}, verdicts.SUPPORTED),  # level is not better
        (
            BEATS,
            {"no_shadow": (0.09, 0.0)},
            verdicts.VACUOUS,
        ),  # what never changes does not flicker
        (BEATS, {}, verdicts.SUPPORTED),
    ],
)
def test_a_ratio_that_what_learns_nothing_has_too_is_vacuous(ratio, nulls, verdict):
    outcome = judged(ratio, {"nsm": LEARNED}, of_nulls(**nulls), networks=["nsm"])
    assert outcome["verdict"] == verdict


@pytest.mark.parametrize(("null", "verdict"), [(0.25, verdicts.VACUOUS), (0.1, verdicts.SUPPORTED)])
def test_a_null_of_shares_is_given(null, verdict):
    ratio = {
        "column": "size",
        "of": {"row": "trimmed"},
        "to": 0.2,
        "at_least": 1,
        "unlearned": null,
    }
    assert judged(ratio, {"nsm": LEARNED}, networks=["nsm"])["verdict"] == verdict


@pytest.mark.parametrize(
    ("ends", "verdict"),
    [
        ((1.1, 1.42), verdicts.CONTRADICTED),
        ((0.9, 1.74), verdicts.UNDECIDED),
        ((None, None), verdicts.TOO_SMALL),
    ],
)
def test_a_number_with_an_interval_of_its_own(ends, verdict):
    low, high = ends
    steps = pd.DataFrame(
        {"row": ["trimmed"], "size": [1.25], "size_low": [low], "size_high": [high]}
    )
    ratio = {"column": "size", "of": {"row": "trimmed"}, "to": 1.0, "at_most": 1}
    outcome = judged(ratio, steps=steps.astype({"size_low": float, "size_high": float}))
    assert outcome["verdict"] == verdict


def test_times_without_a_device_are_a_cpu_s():
    """As those of tables of methods for soft shadows."""
    steps = pd.DataFrame({"row": ["original", "trimmed"], "time": [92.0, 114.0]})
    ratio = {"column": "time", "of": {"row": "trimmed"}, "to": {"row": "original"}, "at_most": 1.1}
    outcome = judged(ratio, steps=steps, needs={"device": "cuda"})
    assert outcome["verdict"] == verdicts.NOT_COMPARABLE
    assert judged(ratio, steps=steps)["verdict"] == verdicts.CONTRADICTED
