from dataclasses import replace

import pytest
from claim_samples import better, loss_curve, measured, points, record, scene, verdict

from neural_shadows.reports.claims.comparison import Comparison, most_against, verdict_of
from neural_shadows.reports.claims.gates import judge
from neural_shadows.reports.data import verdicts
from neural_shadows.reports.data.trained import THESIS_SAMPLES

NEEDS = {"mesh": "thesis", "seeds": 3, "budget": 0.03}
GOOD = {"network": 0.1, "map": 0.2, "null": 0.3, "seeds": 3, "share": 0.05, "mesh": True}
# What spoils the good case, from the last test to the first.
FAILURES = {
    verdicts.UNDECIDED: {"map": 0.1},
    verdicts.CONTRADICTED: {"map": 0.05},
    verdicts.TOO_SMALL: {"seeds": 2},
    verdicts.VACUOUS: {"map": 0.2, "null": 0.15},
    verdicts.NOT_LEARNED: {"null": 0.101},
    verdicts.NOT_COMPARABLE: {"mesh": False},
}


def case(**changes):
    """LPIPS of a network's seeds, a map and no shadow."""
    now = GOOD | changes
    curve = points("net", [now["share"] * THESIS_SAMPLES], now["seeds"])
    methods = {point["experiment"]: {"lpips": now["network"]} for point in curve}
    methods["shadow_map_256"] = {"lpips": now["map"]}
    frames = scene(methods, null={"lpips": now["null"]})
    meshes = {"dragon": {"thesis_mesh": now["mesh"]}}
    return measured({"dragon": frames}, {"net": curve}, meshes=meshes)


def judged(**changes):
    return judge(better(("net", "shadow_map_256"), **NEEDS), case(**changes))


def test_what_passes_every_test_is_supported():
    outcome = judged()
    assert (outcome["verdict"], outcome["null_verdict"]) == ("supported", "contradicted")
    assert (outcome["seeds"], outcome["budget_fraction"]) == (3, pytest.approx(0.05))
    favour = "1 of 1 comparisons are in its favour at 5 % of the thesis's samples"
    assert outcome["reason"] == favour
    assert outcome["evidence"].startswith(
        "LPIPS of net 0.1 against shadow_map_256 0.2: +0.1 [+0.098"
    )


@pytest.mark.parametrize("expected", FAILURES)
def test_each_test_has_its_verdict(expected):
    assert judged(**FAILURES[expected])["verdict"] == expected


def test_the_first_test_that_fails_decides():
    order = [*FAILURES][1:]
    spoilt = {}
    for expected in order:
        spoilt |= FAILURES[expected]
        assert judged(**spoilt)["verdict"] == expected
    assert [name for name in verdicts.VERDICTS if name in order[1:]] == order[:0:-1]


def test_a_mesh_made_to_a_description_is_not_the_thesis_s_own():
    data = replace(case(), scenes={"dragon": {"procedural": True}})
    outcome = judge(better(("net", "shadow_map_256"), **NEEDS), data)
    assert outcome["verdict"] == verdicts.NOT_COMPARABLE
    assert verdict(better(("net", "shadow_map_256")), data) == "supported"


def test_too_small_a_budget_has_what_would_decide_in_its_reason():
    outcome = judged(share=0.01)
    assert outcome["verdict"] == verdicts.TOO_SMALL
    missing = (
        "1 % of the thesis's samples, 3 % are needed; an extrapolation needs 1/30: 2.2 billion"
    )
    assert missing in outcome["reason"]


@pytest.mark.parametrize(
    ("share", "expected"), [(0.03, verdicts.TOO_SMALL), (0.04, "contradicted")]
)
def test_nothing_is_decided_below_a_thirtieth_of_the_samples(share, expected):
    # A claim that needs seeds alone has the share in its reason.
    claim = better(("net", "shadow_map_256"), seeds=3)
    outcome = judge(claim, case(map=0.05, share=share))
    assert outcome["verdict"] == expected
    assert f"against the claim at {100 * share:.2g} % of the thesis's samples" in outcome["reason"]
    assert ("which says nothing of more" in outcome["reason"]) == (share < 1 / 30)
    supported = judge(claim, case(share=share))
    assert supported["verdict"] == (expected if share < 1 / 30 else "supported")
    assert f"in its favour at {100 * share:.2g} % of the thesis's samples" in supported["reason"]
    alike = judge(claim, case(map=0.1, share=share))
    assert alike["verdict"] == (expected if share < 1 / 30 else "undecided")


@pytest.mark.parametrize("share", [0.03, 0.04])
def test_a_map_that_beats_a_network_which_has_learned_counts_from_a_thirtieth(share):
    outcome = judge(better(("shadow_map_256", "net")), case(map=0.05, share=share))
    assert outcome["null_verdict"] == "supported"
    assert outcome["verdict"] == ("vacuous" if share < 1 / 30 else "supported")
    # Where a network is to win, drawing no shadow must not, at any scale.
    spoilt = case(map=0.35, null=0.3, share=share)
    assert judge(better(("net", "shadow_map_256")), spoilt)["verdict"] == "vacuous"


def test_one_training_never_decides_and_more_are_needed_where_configured():
    claim = better(("net", "shadow_map_256"))
    for seeds, expected in ((1, verdicts.TOO_SMALL), (2, "supported")):
        assert verdict(claim, case(seeds=seeds)) == expected
    assert judged(seeds=2)["reason"] == "2 seeds of 3"


@pytest.mark.parametrize(
    ("metric", "value", "null", "reason"),
    [
        ("psnr", 20.0, 20.1, "PSNR beats no shadow by -0."),
        ("ssim", 0.9, 0.9, "SSIM beats no shadow by -0."),
        ("shadow_error", 0.2, 0.2, "shadow error in % beats no shadow by "),
    ],
)
def test_a_network_must_beat_no_shadow_in_the_thesis_s_metrics_and_the_claim_s(
    metric, value, null, reason
):
    """In LPIPS it does, in shadow error not."""
    means = {"lpips": 0.1, "shadow_error": 0.1} | {metric: value}
    methods = {f"net_0_{seed}": means for seed in range(2)}
    methods["shadow_map_256"] = {"lpips": 0.2, "shadow_error": 0.25}
    frames = scene(methods, null={"shadow_error": 0.3} | {metric: null})
    data = measured({"dragon": frames}, {"net": points("net", [THESIS_SAMPLES], 2)})
    claim = better(("net", "shadow_map_256"), metrics=["lpips", "shadow_error"])
    outcome = judge(claim, data)
    assert outcome["verdict"] == "not learned"
    assert f"net (dragon): {reason}" in outcome["reason"]


def test_a_network_must_have_learned_at_the_budget_that_is_compared():
    half, whole = THESIS_SAMPLES // 2, THESIS_SAMPLES
    curves = {"a": points("a", [half, whole], 2), "b": points("b", [half], 2)}
    lpips = {"a_0": 0.35, "a_1": 0.1, "b_0": 0.2}
    methods = {
        point["experiment"]: {"lpips": lpips[point["experiment"][:3]]}
        for curve in curves.values()
        for point in curve
    }
    methods["shadow_map_256"] = {"lpips": 0.2}
    data = measured({"dragon": scene(methods)}, curves)
    assert verdict(better(("b", "a")), data) == "not learned"
    assert verdict(better(("a", "shadow_map_256"), seeds=2), data) == "supported"


def test_one_training_without_content_is_enough():
    curve = points("net", [THESIS_SAMPLES], 3)
    methods = {point["experiment"]: {"lpips": 0.1} for point in curve}
    methods |= {"net_0_2": {"lpips": 0.3}, "shadow_map_256": {"lpips": 0.5}}
    data = measured({"dragon": scene(methods)}, {"net": curve})
    assert verdict(better(("net", "shadow_map_256")), data) == verdicts.NOT_LEARNED


def test_a_network_that_is_only_built_has_no_seeds_and_need_not_have_learned():
    methods = {"built": {"lpips": 0.1}, "shadow_map_256": {"lpips": 0.2}}
    data = measured({"dragon": scene(methods, null={"lpips": 0.05})})
    claim = better(("built", "shadow_map_256"), built=["built"], seeds=3, budget=1)
    outcome = judge(claim, data)
    assert (outcome["verdict"], outcome["null_verdict"]) == ("supported", "")


def test_order_of_scenes_that_no_shadow_has_too_is_vacuous():
    seeds = points("a", [THESIS_SAMPLES], 2), points("b", [THESIS_SAMPLES], 2)
    names = [[point["experiment"] for point in curve] for curve in seeds]
    scenes = {
        "dragon": scene(dict.fromkeys(names[0], {"lpips": 0.1}), {"lpips": 0.2}),
        "fence": scene(dict.fromkeys(names[1], {"lpips": 0.3}), {"lpips": 0.5}),
    }
    data = measured(scenes, dict(zip("ab", seeds)))
    outcome = judge(better(("a", "b"), scenes={"b": "fence"}), data)
    assert (outcome["verdict"], outcome["null_verdict"]) == ("vacuous", "supported")
    assert "a (dragon) 0.1 against b (fence) 0.3" in outcome["evidence"]


def losses(ends, **changes):
    """Three trainings each; `changes` of the last ones' records."""
    curves = {name: points(name, [THESIS_SAMPLES], 3) for name in ends}
    runs = {point["experiment"]: end for name, end in ends.items() for point in curves[name]}
    losses = {run: loss_curve(end + 0.001 * i) for i, (run, end) in enumerate(runs.items())}
    last = [point["experiment"] for point in curves[[*ends][-1]]]
    return measured(
        curves=curves, losses=losses, trainings={run: record(**changes) for run in last}
    )


@pytest.mark.parametrize(
    ("ends", "changes", "expected"),
    [
        ({"a": 0.1, "b": 0.2}, {}, "supported"),
        ({"a": 0.2, "b": 0.1}, {}, "contradicted"),
        ({"a": 0.1, "b": 0.6}, {}, "not learned"),
        ({"a": 0.1, "b": 0.492}, {}, "not learned"),  # 1.6 % below: chance
        # A rate that kills the training is what a claim on rates is about, and the loss before it
        # diverged is of a network that is no more.
        ({"a": 0.1, "b": 0.05}, {"died_at_step": 9}, "supported"),
        ({"b": 0.2, "a": 0.1}, {"died_at_step": 9}, "not learned"),
    ],
)
def test_losses_that_end_above_no_shadow_have_not_learned(ends, changes, expected):
    claim = better(("a", "b"), metrics=["loss"])
    assert verdict(claim, losses(ends, **changes)) == expected


@pytest.mark.parametrize(
    ("p_values", "expected"),
    [
        ([0.03], "contradicted"),
        ([0.03, 1.0], "undecided"),  # Holm: 0.06
        ([0.02, 1.0], "contradicted"),  # 0.04
        ([0.02, 1.0, 1.0], "undecided"),
        ([0.01, 0.02, 0.9, 0.9], "contradicted"),
    ],
)
def test_a_claim_of_many_comparisons_is_contradicted_by_holms_correction(p_values, expected):
    comparisons = [Comparison("lpips", "a", "a", "+1", supports=False, against=p) for p in p_values]
    assert verdict_of(comparisons) == expected


def test_a_support_needs_every_comparison():
    good = Comparison("lpips", "a", "a", "+1", supports=True, against=1.0)
    assert verdict_of([good, good]) == "supported"
    assert verdict_of([good, Comparison("lpips", "a", "a", "+1", False, 1.0)]) == "undecided"


def test_the_number_of_a_claim_is_of_the_comparison_that_decides():
    untested = Comparison("lpips", "a", "a", "", False, 1.0, untested="6 views are too few")
    supporting = Comparison("psnr", "b", "b", "+1.2e+03", True, 1.0)
    chance = Comparison("ssim", "c", "c", "-1", False, 0.4)
    lost = Comparison("flip", "d", "d", "-0.1", False, 0.001)
    # Not the first that is negative.
    assert most_against([untested, supporting, chance, lost]) is lost
    assert most_against([untested, supporting]) is supporting and most_against([untested]) is None
    # With too few seeds nothing is contradicted, but the number is of the same comparison.
    one_seed = [each.without("1 seed of 3") for each in (supporting, chance, lost)]
    assert most_against(one_seed) == one_seed[2] and verdict_of(one_seed) == verdicts.UNDECIDED
    outcome = judged(**FAILURES[verdicts.CONTRADICTED])
    assert (outcome["number_of"], outcome["number"][:6]) == ("LPIPS", "-0.05 ")


def test_an_order_of_losses_that_no_shadow_has_too_is_vacuous():
    """Losses of unlike rays: no shadow costs little on the winner's."""
    data = losses({"a": 0.1, "b": 0.4})
    claim = better(("a", "b"), metrics=["loss"])
    assert judge(claim, data)["null_verdict"] == "undecided"  # 0.5 of both
    runs = [point["experiment"] for point in data.curves["a"]]
    easy = replace(  # between the networks' losses or not
        data, trainings=data.trainings | {run: record(no_shadow_loss=0.45) for run in runs}
    )
    outcome = judge(claim, easy)
    assert (outcome["verdict"], outcome["null_verdict"]) == (verdicts.VACUOUS, "supported")
