from dataclasses import replace

import pytest
from claim_samples import (
    better,
    loss_curve,
    measured,
    pairs,
    points,
    record,
    scene,
    verdict,
)

from neural_shadows.reports import verdicts
from neural_shadows.reports.claims.comparison import Comparison, verdict_of
from neural_shadows.reports.claims.gates import judge
from neural_shadows.reports.claims.measured import THESIS_SAMPLES

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
    """A network of a few seeds at one budget, a map and no shadow: LPIPS of each, 0.002 apart."""
    now = GOOD | changes
    curve = points("net", [now["share"] * THESIS_SAMPLES], now["seeds"])
    methods = {point["experiment"]: {"lpips": now["network"]} for point in curve}
    methods["shadow_map_256"] = {"lpips": now["map"]}
    found = scene(methods, null={"lpips": now["null"]})
    meshes = {"dragon": {"thesis_mesh": now["mesh"]}}
    return measured({"dragon": found}, {"net": curve}, meshes=meshes)


def judged(**changes):
    return judge(better(("net", "shadow_map_256"), **NEEDS), case(**changes))


def test_what_passes_every_test_is_supported():
    found = judged()
    assert (found["verdict"], found["null_verdict"]) == ("supported", "contradicted")
    assert (found["seeds"], found["budget_fraction"]) == (3, pytest.approx(0.05))
    favour = "1 of 1 comparisons are in its favour at 5 % of the thesis's samples"
    assert found["reason"] == favour
    assert found["evidence"].startswith("LPIPS of net 0.1 against shadow_map_256 0.2: +0.1 [+0.098")


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
    found = judge(better(("net", "shadow_map_256"), **NEEDS), data)
    assert found["verdict"] == verdicts.NOT_COMPARABLE
    assert verdict(better(("net", "shadow_map_256")), data) == "supported"


def test_too_small_a_budget_says_what_would_decide():
    found = judged(share=0.01)
    assert found["verdict"] == verdicts.TOO_SMALL
    assert "1 % of the thesis's samples, 3 % are needed (2 billion a network)" in found["reason"]


def test_one_training_never_decides_and_more_are_asked_where_needed():
    claim = better(("net", "shadow_map_256"))
    for seeds, expected in ((1, verdicts.TOO_SMALL), (2, "supported")):
        assert verdict(claim, case(seeds=seeds)) == expected
    assert judged(seeds=2)["reason"] == "2 seeds of 3"


def test_a_network_must_beat_no_shadow_in_each_metric_of_the_claim():
    means = {"lpips": 0.1, "psnr": 20.0}
    methods = {f"net_0_{seed}": means for seed in range(2)}
    methods["shadow_map_256"] = {"lpips": 0.2, "psnr": 15.0}
    found = scene(methods, null={"lpips": 0.3, "psnr": 20.1})
    data = measured({"dragon": found}, {"net": points("net", [THESIS_SAMPLES], 2)})
    for metrics, expected in ((["lpips"], "supported"), (["lpips", "psnr"], "not learned")):
        claim = better(("net", "shadow_map_256"), metrics=metrics)
        assert verdict(claim, data) == expected
    assert "net (dragon): PSNR beats no shadow by -0." in judge(claim, data)["reason"]


def test_one_training_without_content_is_enough():
    curve = points("net", [THESIS_SAMPLES], 3)
    methods = {point["experiment"]: {"lpips": 0.1} for point in curve}
    methods |= {"net_0_2": {"lpips": 0.3}, "shadow_map_256": {"lpips": 0.5}}
    data = measured({"dragon": scene(methods)}, {"net": curve})
    assert verdict(better(("net", "shadow_map_256")), data) == verdicts.NOT_LEARNED


def test_a_network_that_is_only_built_has_no_seeds_and_need_not_have_learned():
    methods = {"built": {"lpips": 0.1}, "shadow_map_256": {"lpips": 0.2}}
    data = measured(
        {"dragon": scene(methods, null={"lpips": 0.05})},
        trainings={"built": record(training=None)},
    )
    found = judge(better(("built", "shadow_map_256"), seeds=3, budget=1), data)
    assert (found["verdict"], found["null_verdict"]) == ("supported", "")


def test_order_of_scenes_that_no_shadow_has_too_is_vacuous():
    seeds = points("a", [THESIS_SAMPLES], 2), points("b", [THESIS_SAMPLES], 2)
    names = [[point["experiment"] for point in some] for some in seeds]
    scenes = {
        "dragon": scene(dict.fromkeys(names[0], {"lpips": 0.1}), {"lpips": 0.2}),
        "fence": scene(dict.fromkeys(names[1], {"lpips": 0.3}), {"lpips": 0.5}),
    }
    data = measured(scenes, dict(zip("ab", seeds)))
    found = judge(better(("a", "b"), scenes={"b": "fence"}), data)
    assert (found["verdict"], found["null_verdict"]) == ("vacuous", "supported")
    assert "a (dragon) 0.1 against b (fence) 0.3" in found["evidence"]


def losses(ends, **changes):
    """Three trainings each that end in a loss; `changes` of the last ones' records."""
    curves = {name: points(name, [THESIS_SAMPLES], 3) for name in ends}
    runs = {point["experiment"]: end for name, end in ends.items() for point in curves[name]}
    found = {run: loss_curve(end + 0.001 * i) for i, (run, end) in enumerate(runs.items())}
    last = [point["experiment"] for point in curves[[*ends][-1]]]
    return measured(curves=curves, losses=found, trainings={run: record(**changes) for run in last})


@pytest.mark.parametrize(
    ("ends", "changes", "expected"),
    [
        ({"a": 0.1, "b": 0.2}, {}, "supported"),
        ({"a": 0.2, "b": 0.1}, {}, "contradicted"),
        ({"a": 0.1, "b": 0.6}, {}, "not learned"),
        # A rate that kills the training is what a claim on rates is about.
        ({"a": 0.1, "b": 0.6}, {"died_at_step": 9}, "supported"),
    ],
)
def test_losses_that_end_above_no_shadow_have_not_learned(ends, changes, expected):
    claim = {"kind": "lower_loss", "pairs": pairs(("a", "b"))}
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
    some = [Comparison("lpips", "a", "+1", supports=False, against=p) for p in p_values]
    assert verdict_of(some) == expected


def test_a_support_needs_every_comparison():
    good = Comparison("lpips", "a", "+1", supports=True, against=1.0)
    assert verdict_of([good, good]) == "supported"
    assert verdict_of([good, Comparison("lpips", "a", "+1", False, 1.0)]) == "undecided"
