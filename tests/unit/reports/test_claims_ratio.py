"""Claims on ratios of tables' numbers, on synthetic tables."""

import pandas as pd
import pytest
from claim_samples import measured

from neural_shadows.reports.claims.gates import judge
from neural_shadows.reports.data import verdicts

STEPS = pd.DataFrame(
    {
        "row": ["original", "trimmed", "half"],
        "size": [26.0, 2.5, 0.0],
        "runtime": [100.0, 28.0, 14.0],
        "light": [0.8, 0.2, 0.1],
        "camera": [0.2, 0.1, 0.1],
        "of_printed_size": True,
    }
)
LEARNED = {
    **{"validation_mse": [0.01, 0.02], "null_mse": {"hard_map": [0.02, 0.05]}},
    "died_at_step": None,
}
HALF, TRIMMED = {"row": "half"}, {"row": "trimmed"}
SIZE = {"column": "size", "at_least": 10}
OF_3_SEEDS = {"networks": ["nsm"], "needs": {"seeds": 3}}


def judged(ratio, trainings=None, steps=STEPS, again=(), **changes):
    ratio = {"table": "steps", "of": {"row": "original"}, "to": TRIMMED, **ratio}
    ratio = {"at_least": None, "at_most": None, "per": None} | ratio
    others = {f"steps_{number}": table for number, table in enumerate(again)}
    claim = {"kind": "ratio", "ratios": [ratio], "networks": [], "needs": {}, **changes}
    claim["again"] = {"steps": [*others]}
    data = measured(tables={"steps": steps, **others}, screen_trainings=trainings or {})
    return judge(claim, data)


@pytest.mark.parametrize(
    ("ratio", "verdict", "words"),
    [
        (SIZE, verdicts.SUPPORTED, "size of original 26 over trimmed 2.5 (steps): ratio 10.4"),
        (SIZE | {"at_least": None, "at_most": 10}, verdicts.CONTRADICTED, "ratio 10.4"),
        (SIZE | {"to": None}, verdicts.SUPPORTED, "over all others 2.5"),
        (SIZE | {"to": {"row": "other"}}, verdicts.TOO_SMALL, "no size of one of them"),
        (SIZE | {"column": "weights"}, verdicts.TOO_SMALL, "no weights of one of them"),
        (SIZE | {"to": [TRIMMED, HALF]}, verdicts.SUPPORTED, "the mean of trimmed and half 1.25"),
        (SIZE | {"to": [TRIMMED, {"row": "other"}]}, verdicts.TOO_SMALL, "no size of one"),
        (SIZE | {"to": 2.0}, verdicts.SUPPORTED, "size of original 26 over 2 (steps): ratio 13"),
        (SIZE | {"to": 2.7}, verdicts.CONTRADICTED, "ratio 9.63"),
        # 0 is within any upper bound.
        ({"column": "size", "of": HALF, "to": 0.02, "at_most": 1}, verdicts.SUPPORTED, "ratio 0"),
        (
            {"column": "light", "per": "camera", "at_least": 2},
            verdicts.SUPPORTED,
            "light per camera of original 4 over trimmed 2 (steps): ratio 2",
        ),
    ],
)
def test_numbers_are_within_bounds(ratio, verdict, words):
    outcome = judged(ratio)
    assert outcome["verdict"] == verdict and words in outcome["evidence"]


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
    outcome = judged(SIZE | {"at_least": 5}, {"nsm": LEARNED}, steps, others, **OF_3_SEEDS)
    assert outcome["verdict"] == verdict
    assert number in f"{outcome['number']} {outcome['reason']}"


@pytest.mark.parametrize(
    ("net", "verdict"), [("squeeze", verdicts.SUPPORTED), ("none", verdicts.TOO_SMALL)]
)
def test_what_a_perceptual_loss_does_needs_one(net, verdict):
    trainings = {"plain": LEARNED | {"perceptual": net}, "l1": LEARNED | {"perceptual": "none"}}
    outcome = judged(SIZE, trainings, networks=["plain", "l1"], needs={"trunk": True})
    assert outcome["verdict"] == verdict
    assert ("pretrained trunk" in outcome["reason"]) == (net == "none")


@pytest.mark.parametrize(
    ("column", "steps", "needed", "verdict"),
    [
        ("runtime", {}, None, verdicts.SUPPORTED),
        ("runtime", {"of_printed_size": False}, None, verdicts.NOT_COMPARABLE),
        ("runtime", {"device": "cpu"}, "cuda", verdicts.NOT_COMPARABLE),
        ("runtime", {"device": "cuda"}, "cuda", verdicts.SUPPORTED),
        # Times of methods for soft shadows have no device: a CPU's, of any size.
        ("time", {"of_printed_size": False}, "cuda", verdicts.NOT_COMPARABLE),
        ("time", {"of_printed_size": False}, None, verdicts.SUPPORTED),
    ],
)
def test_times_are_of_the_paper_s_size_and_may_have_to_be_of_a_gpu(column, steps, needed, verdict):
    steps = STEPS.rename(columns={"runtime": column}).assign(**steps)
    outcome = judged({"column": column, "at_least": 3.5}, steps=steps, needs={"device": needed})
    assert outcome["verdict"] == verdict


@pytest.mark.parametrize(
    ("changes", "verdict", "reason"),
    [
        ({}, verdicts.TOO_SMALL, "1 seed of 3"),
        ({"validation_mse": [0.03, 0.05]}, verdicts.NOT_LEARNED, "hard_map 350"),
        ({"died_at_step": 4000}, verdicts.NOT_LEARNED, "nsm: diverged at step 4,000"),
        # Of a network of the second light alone the first does not count.
        (
            {"validation_mse": [9.0, 0.02], "training": {"lights": [1]}},
            verdicts.TOO_SMALL,
            "1 seed of 3",
        ),
    ],
)
def test_what_networks_measure_needs_seeds_and_that_they_learned(changes, verdict, reason):
    outcome = judged(SIZE, {"nsm": LEARNED | changes}, **OF_3_SEEDS)
    assert outcome["verdict"] == verdict and reason in outcome["reason"]


def of_nulls(**nulls):
    """Errors of networks and nulls on learned and unseen frames."""
    numbers = {"mine": (0.01, 0.012), "other": (0.02, 0.02)} | nulls
    rows = [
        {"label": name, "null": name if name in nulls else None, "frames": frames, "mse": value}
        for name, pair in numbers.items()
        for frames, value in zip(("learned", "unseen"), pair)
    ]
    return pd.DataFrame(rows)


MINE = {"label": "mine", "frames": "unseen"}
CARRIES = {"column": "mse", "of": MINE, "to": MINE | {"frames": "learned"}, "at_most": 1.5}
PER_ITSELF = {"column": "mse", "per": "mse", "of": MINE, "to": 0.9, "at_least": 1}
HARDER = CARRIES | {"at_least": 1.1, "at_most": None}
BEATS = {"column": "mse", "of": {"label": "other", "frames": "unseen"}, "to": MINE, "at_least": 1}


@pytest.mark.parametrize(
    ("ratio", "nulls", "verdict"),
    [
        (
            HARDER,
            {"hard": (0.02, 0.04)},
            verdicts.VACUOUS,
        ),  # these frames are harder for a map, too
        (HARDER, {"hard": (0.04, 0.03)}, verdicts.SUPPORTED),
        (HARDER, {"hard": (0.04, 0.044)}, verdicts.SUPPORTED),  # at the bound
        # A map errs no more in unseen frames: that says nothing of a network which does not.
        (CARRIES, {"hard": (0.04, 0.03)}, verdicts.SUPPORTED),
        # Two networks: in both places it would be the null. What never changes, never flickers.
        (BEATS, {"no_shadow": (0.09, 0.0)}, verdicts.SUPPORTED),
        (BEATS, {}, verdicts.SUPPORTED),
        (PER_ITSELF, {"no_shadow": (0.0, 0.0)}, verdicts.SUPPORTED),  # 0 / 0 is nothing
    ],
)
def test_a_ratio_that_a_null_predictor_has_too_is_vacuous(ratio, nulls, verdict):
    outcome = judged(ratio, {"nsm": LEARNED}, of_nulls(**nulls), networks=["nsm"])
    assert outcome["verdict"] == verdict


@pytest.mark.parametrize(
    ("low", "high", "verdict"),
    [
        (1.1, 1.42, verdicts.CONTRADICTED),
        (0.9, 1.74, verdicts.UNDECIDED),
        (float("nan"), float("nan"), verdicts.TOO_SMALL),
    ],
)
def test_a_number_with_an_interval_of_its_own(low, high, verdict):
    steps = pd.DataFrame({"row": ["half"], "size": 1.25, "size_low": low, "size_high": high})
    ratio = {"column": "size", "of": HALF, "to": 1.0, "at_most": 1}
    assert judged(ratio, steps=steps)["verdict"] == verdict
