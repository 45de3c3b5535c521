"""Claims on methods for soft shadows, on synthetic frames."""

import numpy as np
import pandas as pd
import pytest
from claim_samples import measured
from report_samples import BY_MAP

from neural_shadows.reports.claims.frames import SoftTable, soft_values
from neural_shadows.reports.claims.gates import judge
from neural_shadows.reports.claims.measured import TEXT_SAMPLES
from neural_shadows.reports.data import verdicts

LABELS = {"pcss": "PCSS", "msm_15": "MSM", "rt_1": "1 ray", "rt_4": "4 rays", "rt_4_svgf": "SVGF"}
MSE = {"pcss": 0.010, "msm_15": 0.012, "rt_1": 0.03, "rt_4": 0.008, "rt_4_svgf": 0.001}
# With the map's 5 ms PCSS takes 35 ms at the second radius, and 45 at the third.
OWN_MS = {
    "pcss": [1.0, 30.0, 40.0],
    "msm_15": [1.0, 8.0, 8.0],
    "rt_1": [5.0, 22.0, 22.0],
    "rt_4": [5.0, 36.0, 36.0],
    "rt_4_svgf": [5.0, 12.0, 12.0],
}
RADII = ["point", "0.1 m", "0.2 m"]
PAIR, EQUAL_TIME = ("pcss", "msm_15"), ("rays_of_equal_time", "pcss")
OFF = "mse_off_edges"
SAMPLES = TEXT_SAMPLES["nsm"]
GAINS = np.array([0.002, 0.0021, 0.0019])


def table(errors, labels=LABELS, own_ms=None):
    """A table of errors, rows (scene, frame, radius, metric, method, value)."""
    columns = ["scene", "frame", "radius", "metric", "method", "value"]
    values = soft_values(pd.DataFrame(errors, columns=columns).assign(part="test_000"))
    timed = {
        method: BY_MAP | {"ms": ms, "map": "8" if method in PAIR else None}
        for method, ms in (own_ms or {}).items()
    }
    times = {"maps": {"8": {"ms": 5.0, "texels": 64}}, "methods": timed} if own_ms else None
    return SoftTable(values, labels, times, RADII, range(len(RADII)))


def data(frames=20, noise=0.001, own_ms=OWN_MS, scenes=2, edges=None):
    """Frames with larger differences than methods.

    `edges`: by method the additional error of all pixels.
    """
    rng = np.random.default_rng(4)
    level = rng.uniform(0, 0.02, frames)
    errors = [
        (f"scene {i % scenes}", i, k, metric, method, level[i] + mse + rng.normal(0, noise) + extra)
        for method, mse in MSE.items()
        for k in range(3)
        for i in range(frames)
        for metric, extra in {OFF: 0, "mse": (edges or {}).get(method, 0)}.items()
    ]
    return measured(soft={"soft": table(errors, own_ms=own_ms)})


def claim(pair, **changes):
    shared = {"kind": "better", "table": "soft", "metrics": [OFF], "radii": [1, 2], "needs": {}}
    return shared | {"pairs": [pair]} | changes


@pytest.mark.parametrize(
    ("pair", "changes", "verdict", "words"),
    [
        (PAIR, {}, verdicts.SUPPORTED, "at 0.2 m of PCSS"),
        (PAIR[::-1], {}, verdicts.CONTRADICTED, "against PCSS"),
        (PAIR, {"noise": 0.05}, verdicts.UNDECIDED, ""),
        (PAIR, {"frames": 6}, verdicts.TOO_SMALL, "6 frames are too few: it takes 10"),
        (PAIR, {"frames": 16, "scenes": 1}, verdicts.SUPPORTED, "] over 16 frames in 1 scene"),
        (PAIR, {"frames": 16, "scenes": 4}, verdicts.SUPPORTED, "] over 16 frames in 4 scenes"),
        (PAIR, {"frames": 16, "scenes": 8}, verdicts.SUPPORTED, "] over 8 scenes"),
        # PCSS has more error at edges than moments in all.
        (PAIR, {"scenes": 8, "edges": {"pcss": 0.01}}, verdicts.SUPPORTED, "them: contradicted"),
        # At 0.1 m one ray, which fits, loses, and four, which take a millisecond more, win.
        (EQUAL_TIME, {}, verdicts.UNDECIDED, "0.1 m of 4 rays"),
        (EQUAL_TIME, {}, verdicts.UNDECIDED, "; beside it MSE × 10⁻⁴ off edges at 0.1 m of 1 ray"),
        (EQUAL_TIME, {"own_ms": OWN_MS | {"rt_4": [5.0, 34.0, 36.0]}}, verdicts.SUPPORTED, ""),
        (EQUAL_TIME[::-1], {"own_ms": OWN_MS | {"rt_4": [5.0] * 3}}, verdicts.CONTRADICTED, ""),
        # Even one ray, which loses, takes longer.
        (
            EQUAL_TIME,
            {"own_ms": OWN_MS | {"pcss": [1.0, 1.0, 1.0]}},
            verdicts.CONTRADICTED,
            "0.1 m of 1 ray ",
        ),
        (EQUAL_TIME[::-1], {"own_ms": OWN_MS | {"pcss": [1.0] * 3}}, verdicts.SUPPORTED, ""),
        # Four rays lose in less time, and no more are timed.
        (
            ("rt_4_svgf", "rays_of_equal_time"),
            {"own_ms": OWN_MS | {"rt_4_svgf": [90.0] * 3}},
            verdicts.TOO_SMALL,
            "against 4 rays",
        ),
        (EQUAL_TIME, {"own_ms": None}, verdicts.TOO_SMALL, "PCSS at 0.1 m: the table has no times"),
    ],
)
def test_frames_are_compared_in_pairs(pair, changes, verdict, words):
    outcome = judge(claim(pair), data(**changes))
    assert outcome["verdict"] == verdict
    assert words in outcome["evidence"] and "nan" not in outcome["evidence"]


def test_a_method_loses_to_the_filtered_rays_of_its_time():
    """Of 30 ms these are four, whose error is less; of 20 ms two, and three err more, too."""
    labels = {"pcss": "PCSS", "rt_4": "4 rays"}
    labels |= {f"rt_{n}_ffx": f"{n} rays, FFX" for n in (2, 3, 4)}
    mse = {"pcss": 0.010, "rt_2_ffx": 0.020, "rt_3_ffx": 0.015, "rt_4_ffx": 0.005, "rt_4": 0.001}
    errors = [
        (f"scene {i % 2}", i, 0, OFF, method, mse[method] + 0.001 * (i % 5) * (method == "pcss"))
        for i in range(20)
        for method in labels
    ]
    verdict_of = {}
    for own in (25.0, 18.0, 15.0):  # and the map's 5 ms
        own_ms = {"pcss": [own], "rt_4": [19.0]}
        own_ms |= {"rt_2_ffx": [18.0], "rt_3_ffx": [22.0], "rt_4_ffx": [27.0]}
        soft = {"soft": table(errors, labels, own_ms)}
        outcome = judge(claim(("pcss", "ffx_rays_of_equal_time"), radii=[0]), measured(soft=soft))
        verdict_of[own] = outcome["verdict"]
        named = {25.0: "against 4 rays", 18.0: "against 3 rays", 15.0: "against 3 rays"}[own]
        assert f"{named}, FFX" in outcome["evidence"]
    by_time = [verdicts.CONTRADICTED, verdicts.UNDECIDED, verdicts.SUPPORTED]
    assert [*verdict_of.values()] == by_time


def test_a_claim_may_be_on_unseen_scenes_alone():
    """In the others PCSS errs more."""
    gains = {f"scene {i}": (0.004 + 0.0001 * i) * (1 if i < 6 else -4) for i in range(12)}
    errors = [
        (scene, frame, 0, OFF, method, 0.02 + (method == "msm_15") * gain)
        for scene, gain in gains.items()
        for frame in range(3)
        for method in PAIR
    ]
    data_of = measured(soft={"soft": table(errors)})
    assert judge(claim(PAIR, radii=[0]), data_of)["verdict"] != verdicts.SUPPORTED
    unseen = claim(PAIR, radii=[0], scenes=[f"scene {i}" for i in range(6)])
    outcome = judge(unseen, data_of)
    assert outcome["verdict"] == verdicts.SUPPORTED and "over 6 scenes" in outcome["evidence"]


def test_a_point_light_is_named():
    assert "at a point light of PCSS" in judge(claim(PAIR, radii=[0]), data())["evidence"]


def test_a_missing_metric_is_named():
    outcome = judge(claim(PAIR, metrics=["lpips"]), data())
    assert outcome["verdict"] == verdicts.TOO_SMALL and "no LPIPS of PCSS, MSM" in outcome["reason"]


def test_a_method_that_this_machine_lacks_is_named():
    """Open Image Denoise has no package for every processor; the other claims are judged."""
    outcome = judge(claim(("rt_1_oidn", "pcss")), data())
    assert (
        outcome["verdict"] == verdicts.TOO_SMALL and "off edges of rt_1_oidn" in outcome["reason"]
    )


def test_scenes_are_what_a_claim_is_about():
    """Many frames of five scenes, two of them contrary."""
    errors = [
        (str(scene), frame, 0, OFF, method, 0.01 + (method == "msm_15") * gain)
        for scene, gain in enumerate((0.004, 0.003, 0.005, -0.002, -0.001))
        for frame in range(40)
        for method in PAIR
    ]
    outcome = judge(claim(PAIR, radii=[0]), measured(soft={"soft": table(errors)}))
    assert outcome["verdict"] == verdicts.UNDECIDED and "over 5 scenes" in outcome["evidence"]


def of_networks(gains, metric=OFF, equal_time=False, samples=SAMPLES, nulls=None, **needs):
    """A network better than PCSS by each seed's gain, of three needed ones.

    One ray is as PCSS, in the time of the network; so are two, in more.
    """
    runs = [f"mine_{seed}" for seed in range(len(gains))]
    errors = {"pcss": 0.01, "rt_1": 0.01, "rt_2": 0.01, "hard": 0.02} | (nulls or {})
    errors |= {run: 0.01 - gain for run, gain in zip(runs, gains)}
    rng = np.random.default_rng(4)
    rows = [
        (("room", "tree")[i % 2], i, k, name, method, value + rng.normal(0, 1e-4))
        for i in range(20)
        for k in range(3)
        for method, value in errors.items()
        for name in {metric, "mse"}
    ]
    labels = {"pcss": "PCSS", "rt_1": "1 ray", "rt_2": "2 rays", runs[0]: "Mine"}
    own_ms = {runs[0]: [9.0] * 3, "rt_1": [9.0] * 3, "rt_2": [12.0] * 3} if equal_time else None
    record = {"validation_mse": [0.01], "null_mse": {"hard_map": [0.02]}, "died_at_step": None}
    trainings = dict.fromkeys(runs, record | {"samples": samples})
    values = measured(soft={"soft": table(rows, labels, own_ms)}, screen_trainings=trainings)
    pair = ("rays_of_equal_time", runs[0]) if equal_time else (runs[0], "pcss")
    changes = {"again": {runs[0]: runs[1:]}, "networks": runs, "needs": {"seeds": 3} | needs}
    bases = dict.fromkeys(runs, "base_hard") if "base_hard" in errors else {}
    changes |= {"text": "nsm", "bases": bases, "radii": [1] if equal_time else None}
    return claim(pair, metrics=[metric], **changes), values


@pytest.mark.parametrize("equal_time", [False, True])
@pytest.mark.parametrize(
    ("gains", "verdict"),
    [
        (GAINS, verdicts.SUPPORTED),
        (-GAINS, verdicts.CONTRADICTED),
        ([0.004, -0.003, 0.002], verdicts.UNDECIDED),
        ([0.002, 0.002], verdicts.TOO_SMALL),
    ],
)
def test_three_trainings_decide(gains, verdict, equal_time):
    """Their differences count as much as those of frames."""
    outcome = judge(*of_networks(-np.array(gains) if equal_time else gains, equal_time=equal_time))
    assert (outcome["verdict"], outcome["seeds"]) == (verdict, len(gains))
    words = " ms) against Mine " if equal_time else "MSE × 10⁻⁴ off edges at all lights of Mine"
    assert words in outcome["evidence"] and "nan" not in outcome["evidence"]
    assert verdict != verdicts.TOO_SMALL or "2 seeds of 3" in outcome["reason"]


def test_of_a_network_two_trainings_are_needed_by_default():
    assert "1 seed of 2" in judge(*of_networks(GAINS[:1], seeds=None))["reason"]


def test_rays_that_beat_what_has_not_learned_decide_nothing():
    claim_of_network, values = of_networks(-GAINS, equal_time=True)
    values.screen_trainings["mine_1"] = values.screen_trainings["mine_0"] | {
        "validation_mse": [0.03]
    }
    assert judge(claim_of_network, values)["verdict"] == verdicts.NOT_LEARNED


def test_of_ssim_more_is_better():
    outcome = judge(*of_networks(-GAINS, "ssim", nulls={"hard": 0.001}))
    assert outcome["verdict"] == verdicts.SUPPORTED


@pytest.mark.parametrize(
    ("null", "named"), [("hard", "hard"), ("no_shadow", "no shadow"), ("base_hard", "base")]
)
def test_a_network_s_lead_that_what_learns_nothing_has_too_is_vacuous(null, named):
    outcome = judge(*of_networks(GAINS, nulls={null: 0.005}))
    assert (outcome["verdict"], outcome["null_verdict"]) == (verdicts.VACUOUS, "supported")
    assert f"with {named} in place of the networks" in outcome["reason"]


@pytest.mark.parametrize(
    ("samples", "verdict"), [(SAMPLES, verdicts.SUPPORTED), (SAMPLES // 240, verdicts.VACUOUS)]
)
def test_rays_that_beat_a_map_as_well_are_vacuous_below_a_thirtieth(samples, verdict):
    changes = {"equal_time": True, "nulls": {"hard": 0.02}, "samples": samples}
    outcome = judge(*of_networks(-GAINS, **changes))
    assert (outcome["verdict"], outcome["null_verdict"]) == (verdict, "supported")
    words = "they do at 0.42 % of Datta et al. 2022's pixels"
    assert outcome["reason"].endswith(words) == (verdict == verdicts.VACUOUS)


@pytest.mark.parametrize(
    ("share", "gains", "budget", "verdict"),
    [
        (1 / 240, -GAINS, None, verdicts.TOO_SMALL),
        (1 / 20, -GAINS, None, verdicts.CONTRADICTED),
        (1 / 240, GAINS, 1, verdicts.TOO_SMALL),
        (1 / 240, GAINS, None, verdicts.TOO_SMALL),
        (1 / 20, GAINS, None, verdicts.SUPPORTED),
        (1, GAINS, 1, verdicts.SUPPORTED),
    ],
)
def test_a_paper_s_networks_have_the_thesis_s_standard(share, gains, budget, verdict):
    samples = round(share * SAMPLES)
    outcome = judge(*of_networks(gains, samples=samples, budget=budget))
    assert outcome["verdict"] == verdict and outcome["budget_fraction"] == pytest.approx(share)
    assert (outcome["samples"], outcome["text_samples"]) == (samples, SAMPLES)
