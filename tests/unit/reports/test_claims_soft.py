"""Claims on methods for soft shadows, on synthetic frames."""

import numpy as np
import pandas as pd
import pytest
from claim_samples import measured

from neural_shadows.reports.claims.gates import judge
from neural_shadows.reports.claims.measured import TEXT_SAMPLES
from neural_shadows.reports.claims.soft_claims import SoftTable, soft_values
from neural_shadows.reports.data import verdicts

LABELS = {"pcss": "PCSS", "msm_15": "MSM", "rt_1": "1 ray", "rt_4": "4 rays", "rt_4_svgf": "SVGF"}
MSE = {"pcss": 0.010, "msm_15": 0.012, "rt_1": 0.03, "rt_4": 0.008, "rt_4_svgf": 0.001}
TIMES = {
    "maps": {"8": {"ms": 5.0, "texels": 64}},
    "methods": {
        "pcss": {"ms": [1.0, 30.0, 40.0], "map": "8", "texel_floats": 1},
        "msm_15": {"ms": [1.0, 8.0, 8.0], "map": "8", "texel_floats": 4},
        "rt_1": {"ms": [5.0, 10.0, 10.0], "map": None, "texel_floats": 0},
        "rt_4": {"ms": [5.0, 36.0, 36.0], "map": None, "texel_floats": 0},
        "rt_4_svgf": {"ms": [5.0, 12.0, 12.0], "map": None, "texel_floats": 0},
    },
}


RADII = ["0 m", "0.1 m", "0.2 m"]


OFF = "mse_off_edges"


def data(frames=20, noise=0.001, methods=TIMES["methods"], scenes=2, edges=None):
    """Frames with larger differences than methods.

    `edges`: by method the additional error of all pixels.
    """
    rng = np.random.default_rng(4)
    level = rng.uniform(0, 0.02, frames)
    rows = [
        {
            "scene": f"scene {i % scenes}",
            "part": "test_000",
            "frame": i,
            "radius": k,
            "metric": metric,
        }
        | {"method": method, "value": level[i] + mse + rng.normal(0, noise) + extra}
        for method, mse in MSE.items()
        for k in range(3)
        for i in range(frames)
        for metric, extra in {OFF: 0, "mse": (edges or {}).get(method, 0)}.items()
    ]
    table = SoftTable(soft_values(pd.DataFrame(rows)), LABELS, TIMES | {"methods": methods}, RADII)
    return measured(soft={"soft": table})


def claim(kind, **changes):
    return {
        "kind": kind,
        "table": "soft",
        "needs": {},
        "metrics": [OFF],
        "radii": [1, 2],
        **changes,
    }


@pytest.mark.parametrize(
    ("pair", "verdict"),
    [(["pcss", "msm_15"], verdicts.SUPPORTED), (["msm_15", "pcss"], verdicts.CONTRADICTED)],
)
def test_frames_are_compared_in_pairs(pair, verdict):
    outcome = judge(claim("soft_better", pairs=[pair]), data())
    assert outcome["verdict"] == verdict
    assert "PCSS" in outcome["evidence"] and "at 0.2 m" in outcome["evidence"]


def test_noise_and_few_frames_decide_nothing():
    pairs = [["pcss", "msm_15"]]
    assert judge(claim("soft_better", pairs=pairs), data(noise=0.05))["verdict"] == "undecided"
    outcome_of_few = judge(claim("soft_better", pairs=pairs), data(frames=6))
    assert (
        outcome_of_few["verdict"] == verdicts.TOO_SMALL
        and "6 frames are too few" in outcome_of_few["reason"]
    )


def test_as_many_rays_as_fit_into_the_time():
    """PCSS takes 35 ms like one ray, 45 like four."""
    outcome = judge(claim("soft_equal_time", methods=["pcss"]), data())
    first, second = outcome["evidence"].split("\n")
    assert "1 ray" in first and "(10 ms) against PCSS" in first
    assert "4 rays" in second and "SVGF" not in outcome["evidence"]
    assert outcome["verdict"] == verdicts.CONTRADICTED  # at the first radius one ray is worse
    later = judge(claim("soft_equal_time", methods=["pcss"], radii=[2]), data())
    assert later["verdict"] == verdicts.SUPPORTED


def test_a_method_that_is_faster_than_any_ray_is_not_judged():
    quick = TIMES["methods"] | {"msm_15": {"ms": [1.0, 1.0, 1.0], "map": "8", "texel_floats": 4}}
    outcome = judge(claim("soft_equal_time", methods=["msm_15"]), data(methods=quick))
    assert (
        outcome["verdict"] == verdicts.TOO_SMALL and "no number of rays fits" in outcome["reason"]
    )


def test_a_missing_metric_is_named():
    outcome = judge(claim("soft_better", pairs=[["pcss", "msm_15"]], metrics=["lpips"]), data())
    assert outcome["verdict"] == verdicts.TOO_SMALL and "no LPIPS of PCSS, MSM" in outcome["reason"]


def of_networks(
    seeds, gains, metric=OFF, kind="soft_better", samples=TEXT_SAMPLES["nsm"], nulls=()
):
    """A network better than PCSS by each seed's gain.

    One ray is as PCSS, in the time of the network.
    """
    runs = ["mine", *(f"mine_{seed}" for seed in range(1, seeds))]
    errors = {
        "pcss": 0.01,
        "rt_1": 0.01,
        "hard": 0.02,
        **dict(nulls),
        **{run: 0.01 - gain for run, gain in zip(runs, gains)},
    }
    rng = np.random.default_rng(4)
    rows = [
        {"scene": ("room", "tree")[i % 2], "part": "test_000", "frame": i, "radius": k}
        | {"metric": name, "method": method, "value": value + rng.normal(0, 1e-4)}
        for i in range(20)
        for k in range(3)
        for method, value in errors.items()
        for name in {metric, "mse"}
    ]
    labels = {"pcss": "PCSS", "rt_1": "1 ray", "mine": "Mine"}
    timed = {
        method: {"ms": [9.0] * 3, "map": None, "texel_floats": 0} for method in ("mine", "rt_1")
    }
    times = (
        {"maps": {"8": {"ms": 5.0, "texels": 64}}, "methods": timed}
        if kind == "soft_equal_time"
        else None
    )
    table = SoftTable(soft_values(pd.DataFrame(rows)), labels, times, RADII)
    record = {"validation_mse": [0.01], "null_mse": {"hard_map": [0.02]}, "died_at_step": None}
    record["samples"] = samples
    values = measured(soft={"soft": table}, screen_trainings=dict.fromkeys(runs, record))
    changes = {"again": {"mine": runs[1:]}, "networks": runs, "needs": {"seeds": 3}, "radii": None}
    changes |= {
        "text": "nsm",
        "bases": dict.fromkeys(runs, "base_hard") if "base_hard" in dict(nulls) else {},
    }
    if kind == "soft_equal_time":
        return claim(kind, methods=["mine"], **changes | {"radii": [1]}), values
    return claim(kind, pairs=[["mine", "pcss"]], metrics=[metric], **changes), values


@pytest.mark.parametrize(
    ("gains", "verdict"),
    [
        ([0.002, 0.0021, 0.0019], verdicts.SUPPORTED),
        ([-0.002, -0.0021, -0.0019], verdicts.CONTRADICTED),
        ([0.004, -0.003, 0.002], verdicts.UNDECIDED),
        ([0.002, 0.002], verdicts.TOO_SMALL),
    ],
)
def test_three_trainings_decide_over_all_lights(gains, verdict):
    """Their differences count as much as those of frames."""
    outcome = judge(*of_networks(len(gains), gains))
    assert outcome["verdict"] == verdict
    assert (
        "MSE × 10⁻⁴ off edges at all lights of Mine" in outcome["evidence"]
        and "nan" not in outcome["evidence"]
    )
    assert verdict != verdicts.TOO_SMALL or "2 seeds of 3" in outcome["reason"]


@pytest.mark.parametrize(
    ("gains", "verdict"),
    [
        ([-0.002, -0.0021, -0.0019], verdicts.SUPPORTED),
        ([0.002, 0.0021, 0.0019], verdicts.CONTRADICTED),
        ([-0.004, 0.003, -0.002], verdicts.UNDECIDED),
        ([-0.002], verdicts.TOO_SMALL),
    ],
)
def test_rays_of_a_network_s_time_are_judged_by_its_trainings(gains, verdict):
    outcome = judge(*of_networks(len(gains), gains, kind="soft_equal_time"))
    assert outcome["verdict"] == verdict and "(9 ms) against Mine " in outcome["evidence"]
    assert verdict != verdicts.TOO_SMALL or "1 seed of 3" in outcome["reason"]


def test_of_a_network_two_trainings_are_needed_by_default():
    claim_of_network, values = of_networks(1, [-0.002], kind="soft_equal_time")
    assert "1 seed of 2" in judge({**claim_of_network, "needs": {}}, values)["reason"]


def test_rays_that_beat_what_has_not_learned_decide_nothing():
    claim_of_network, values = of_networks(3, [-0.002, -0.0021, -0.0019], kind="soft_equal_time")
    trainings = values.screen_trainings
    trainings["mine_1"] = trainings["mine"] | {"validation_mse": [0.03]}
    assert judge(claim_of_network, values)["verdict"] == verdicts.NOT_LEARNED


def test_of_ssim_more_is_better():
    gains = [-0.002, -0.0021, -0.0019]
    assert (
        judge(*of_networks(3, gains, "ssim", nulls=[("hard", 0.001)]))["verdict"]
        == verdicts.SUPPORTED
    )


@pytest.mark.parametrize(
    ("scenes", "frames", "units"),
    [(1, 16, "16 frames in 1 scene"), (4, 16, "16 frames in 4 scenes"), (8, 16, "8 scenes")],
)
def test_the_evidence_names_what_is_counted(scenes, frames, units):
    pair = [["pcss", "msm_15"]]
    outcome = judge(claim("soft_better", pairs=pair), data(frames=frames, scenes=scenes))
    assert f"] over {units}" in outcome["evidence"]


def test_scenes_are_what_a_claim_is_about():
    """Many frames of five scenes, two of them contrary."""
    rows = [
        {"scene": str(scene), "part": "test_000", "frame": frame, "radius": 0, "metric": OFF}
        | {"method": method, "value": 0.01 + (method == "msm_15") * gain}
        for scene, gain in enumerate((0.004, 0.003, 0.005, -0.002, -0.001))
        for frame in range(40)
        for method in ("pcss", "msm_15")
    ]
    table = SoftTable(soft_values(pd.DataFrame(rows)), LABELS, None, RADII[:1])
    paired = claim("soft_better", pairs=[["pcss", "msm_15"]], radii=[0])
    outcome = judge(paired, measured(soft={"soft": table}))
    assert outcome["verdict"] == verdicts.UNDECIDED and "over 5 scenes" in outcome["evidence"]


def test_another_verdict_of_all_pixels_is_in_the_evidence():
    """PCSS has more error at edges than moments in all."""
    paired = claim("soft_better", pairs=[["pcss", "msm_15"]])
    unlike = judge(paired, data(scenes=8, edges={"pcss": 0.01}))
    assert unlike["verdict"] == verdicts.SUPPORTED
    assert unlike["evidence"].endswith("edges of surfaces among them: contradicted")
    assert "By the error of all pixels" not in judge(paired, data(scenes=8))["evidence"]
    equal = claim("soft_equal_time", methods=["pcss"], radii=[2])
    unlike = judge(equal, data(scenes=8, edges={"rt_4": 0.01}))
    assert unlike["verdict"] == verdicts.SUPPORTED
    assert unlike["evidence"].endswith("edges of surfaces among them: contradicted")


GAINS = [0.002, 0.0021, 0.0019]


@pytest.mark.parametrize(
    ("nulls", "named"),
    [
        ({"hard": 0.005}, "hard"),
        ({"no_shadow": 0.005}, "no shadow"),
        ({"base_hard": 0.005}, "base"),
    ],
)
def test_a_network_s_lead_that_what_learns_nothing_has_too_is_vacuous(nulls, named):
    outcome = judge(*of_networks(3, GAINS, nulls=nulls.items()))
    assert (outcome["verdict"], outcome["null_verdict"]) == (verdicts.VACUOUS, "supported")
    assert f"with {named} in place of the networks" in outcome["reason"]


def test_rays_that_beat_a_map_as_well_are_vacuous_below_a_thirtieth():
    lost = [-gain for gain in GAINS]
    changes = {"kind": "soft_equal_time", "nulls": [("hard", 0.02)]}
    outcome_of_all = judge(*of_networks(3, lost, **changes))
    assert (outcome_of_all["verdict"], outcome_of_all["null_verdict"]) == (
        verdicts.SUPPORTED,
        "supported",
    )
    outcome_of_few = judge(*of_networks(3, lost, **changes, samples=TEXT_SAMPLES["nsm"] // 240))
    assert outcome_of_few["verdict"] == verdicts.VACUOUS
    assert outcome_of_few["reason"].endswith("they do at 0.42 % of Datta et al. 2022's pixels")


@pytest.mark.parametrize(
    ("share", "gains", "budget", "verdict"),
    [
        (1 / 240, -1, None, verdicts.TOO_SMALL),
        (1 / 20, -1, None, verdicts.CONTRADICTED),
        (1 / 240, 1, 1, verdicts.TOO_SMALL),
        (1 / 240, 1, None, verdicts.SUPPORTED),
        (1, 1, 1, verdicts.SUPPORTED),
    ],
)
def test_a_paper_s_networks_have_the_thesis_s_standard(share, gains, budget, verdict):
    samples = round(share * TEXT_SAMPLES["nsm"])
    claim_of_network, values = of_networks(3, [gains * gain for gain in GAINS], samples=samples)
    outcome = judge(claim_of_network | {"needs": {"seeds": 3, "budget": budget}}, values)
    assert outcome["verdict"] == verdict and outcome["budget_fraction"] == pytest.approx(share)
    assert (outcome["samples"], outcome["text_samples"]) == (samples, TEXT_SAMPLES["nsm"])
