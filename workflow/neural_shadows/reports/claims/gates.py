"""A claim's tests in order; the first failed one decides."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from neural_shadows.metrics.power_law import LARGEST_STEP
from neural_shadows.reports.claims.claim_kinds import by_kind, kind_of, methods
from neural_shadows.reports.claims.comparison import (
    Comparison,
    against,
    most_against,
    seeds_of,
    verdict_of,
)
from neural_shadows.reports.claims.learning import AWAY, NEITHER, TOWARDS
from neural_shadows.reports.claims.measured import TEXT_SAMPLES, Claim, Measured, needs
from neural_shadows.reports.data import verdicts
from neural_shadows.reports.data.phrases import TEXTS, is_own_mesh

# Two trainings are enough for an interval of Student's t with one degree of freedom: 12.7 standard
# errors either way.
LEAST_SEEDS = 2
# A smaller share of a text's samples may not be extrapolated, and decides nothing on its networks.
DECISIVE = 1 / LARGEST_STEP
WHOSE = {"thesis": "the thesis's samples"} | {
    name: f"{paper}'s pixels" for name, paper in TEXTS.items()
}
MOVING = {
    TOWARDS: "moving towards the claim",
    AWAY: "moving away from the claim",
    NEITHER: "moving neither towards the claim nor away",
}


def judge(claim: Claim, data: Measured) -> dict[str, Any]:
    """Test a resolved claim.

    Returns: the columns of claims.csv from `verdict` to `text_samples`.
    """
    comparisons = kind_of(claim).comparisons(claim, data)
    if pixels := data.pixels(claim):
        comparisons = [replace(each, samples=pixels) for each in comparisons]
    null, passing = null_verdict(claim, data)
    extrapolated = extrapolate(claim, comparisons)
    judged_comparisons = extrapolated or comparisons
    gates = {
        verdicts.NOT_COMPARABLE: not_comparable(claim, comparisons, data),
        verdicts.NOT_LEARNED: by_kind(claim, "not_learned", data, default=""),
        verdicts.VACUOUS: vacuous(claim, judged_comparisons, passing),
        verdicts.TOO_SMALL: too_small(claim, comparisons, extrapolated),
        verdict_of(judged_comparisons): decided(claim, judged_comparisons, bool(extrapolated)),
    }
    verdict, reason = next((verdict, reason) for verdict, reason in gates.items() if reason)
    seeds = [each.seeds for each in comparisons if each.seeds is not None]
    samples = [each.samples for each in comparisons if each.samples is not None]
    shown = most_against(judged_comparisons)
    evidence = "\n".join(each.evidence for each in comparisons)
    all_pixels = by_kind(claim, "by_all_pixels", default=None)
    if all_pixels and (unlike := judge(all_pixels, data)["verdict"]) != verdict:
        evidence += f". By the error of all pixels, edges of surfaces among them: {unlike}"
    return {
        "verdict": verdict,
        "reason": reason,
        "metric": ", ".join(dict.fromkeys(each.metric for each in comparisons)),
        "seeds": min(seeds, default=np.nan),
        "budget_fraction": min(samples, default=np.nan) / samples_of_text(claim),
        **trend_of(comparisons),
        "null_verdict": null,
        "number_of": shown.metric_name if shown else "",
        "number": shown.number if shown else "",
        "evidence": evidence,
        "samples": min(samples, default=np.nan),
        "text_samples": samples_of_text(claim),
    }


def samples_of_text(claim: Claim) -> int:
    """Training samples of networks of a claim's text."""
    return TEXT_SAMPLES[claim.get("text", "thesis")]


def not_comparable(claim: Claim, comparisons: Sequence[Comparison], data: Measured) -> str:
    """The reason against comparable measurements, if any."""
    if needs(claim, "mesh") == "thesis":
        scenes = dict.fromkeys(row["scene"] for row in methods(claim))
        if stand_ins := [s for s in scenes if not is_own_mesh(data.meshes[s], data.scenes[s])]:
            return f"not the thesis's mesh: {', '.join(stand_ins)}"
    reasons = {each.methods: each.incomparable for each in comparisons if each.incomparable}
    return "; ".join(f"{compared}: {reason}" for compared, reason in reasons.items())


def null_verdict(claim: Claim, data: Measured) -> tuple[str, str]:
    """The verdict with null predictors for networks, and supported ones.

    Both are empty for kinds without null predictors.
    """
    nulls = by_kind(claim, "without_networks", data, default={})
    verdicts_of = {null: verdict_of(comparisons) for null, comparisons in nulls.items()}
    passing = [null for null, verdict in verdicts_of.items() if verdict == verdicts.SUPPORTED]
    if passing:
        return verdicts.SUPPORTED, " and ".join(passing).replace("_", " ")
    return next(iter(verdicts_of.values()), ""), ""


def vacuous(claim: Claim, comparisons: Sequence[Comparison], passing: str) -> str:
    """The reason for a vacuous support, if it is one.

    Any map beats no shadow. A claim that maps beat a network is therefore not vacuous if the network
    has a thirtieth or more of its text's samples.

    Args:
        passing: the null predictors with support in the networks' place.
    """
    if not passing or verdict_of(comparisons) != verdicts.SUPPORTED:
        return ""
    if by_kind(claim, "network_wins", default=True):
        return f"supported as well with {passing} in place of the networks"
    if (least := fewest_samples(comparisons)) < DECISIVE * samples_of_text(claim):
        return (
            f"{passing} in the networks' place loses as well, and they do at {share(claim, least)}"
        )
    return ""


def extrapolate(claim: Claim, comparisons: Sequence[Comparison]) -> list[Comparison]:
    """The comparisons, those of too few samples extrapolated.

    Empty if all have enough for the claim, or if one's learning curves license no extrapolation.
    """
    below = [below_budget(claim, each) for each in comparisons]
    extrapolated = [each.extrapolated if b else each for each, b in zip(comparisons, below)]
    return extrapolated if any(below) and all(extrapolated) else []


def below_budget(claim: Claim, comparison: Comparison) -> bool:
    """Compare a comparison's samples with the needed share."""
    least = (needs(claim, "budget") or 0.0) * samples_of_text(claim)
    return comparison.samples is not None and comparison.samples < least


def fewest_samples(comparisons: Sequence[Comparison]) -> float:
    """The fewest training samples; infinite if nothing is trained."""
    samples = [each.samples for each in comparisons if each.samples is not None]
    return min(samples, default=np.inf)


def too_small(
    claim: Claim, comparisons: Sequence[Comparison], extrapolated: Sequence[Comparison]
) -> str:
    """Missing seeds, views or samples, and the difference's direction."""
    least_seeds = by_kind(claim, "LEAST_SEEDS", default=LEAST_SEEDS)
    needed = needs(claim, "seeds") or least_seeds  # 1: of weights as they are
    learning = deciding(comparisons).learning
    opposing = against(extrapolated or comparisons)
    # One comparison is enough against a claim.
    untested = dict.fromkeys(each.untested for each in comparisons if each.untested)
    reasons = [] if opposing else [*untested]
    trained = [each for each in comparisons if each.samples is not None]
    seeds = min((each.seeds for each in trained if each.seeds is not None), default=needed)
    if seeds < needed:
        reasons.append(seeds_of(seeds, needed))
    if any(below_budget(claim, each) for each in comparisons) and not extrapolated:
        least, budget = fewest_samples(comparisons), needs(claim, "budget")
        reasons.append(f"{share(claim, least)}, {100 * budget:.3g} % are needed")
        if least < (enough := DECISIVE * samples_of_text(claim)):
            reasons.append(
                f"an extrapolation needs 1/{LARGEST_STEP}: {enough / 1e9:.2g} billion a network"
            )
        if learning and learning.unlicensed:
            reasons.append(f"no extrapolation: {learning.unlicensed}")
    elif (least := fewest_samples(opposing or comparisons)) < DECISIVE * samples_of_text(claim):
        where = f"at {share(claim, least)}, which says nothing of more"
        reasons.append(f"{_side(opposing, comparisons)} {where}")
    if reasons and (moving := direction_of(comparisons)):
        reasons.append(MOVING[moving])
    return "; ".join(dict.fromkeys(reasons))


def _side(opposing: Sequence[Comparison], comparisons: Sequence[Comparison]) -> str:
    if opposing:
        return "against the claim"
    return "in its favour" if verdict_of(comparisons) == verdicts.SUPPORTED else verdicts.UNDECIDED


def share(claim: Claim, samples: float) -> str:
    """Training samples of a network in words."""
    samples_name = WHOSE[claim.get("text", "thesis")]
    return f"{100 * samples / samples_of_text(claim):.2g} % of {samples_name}"


def decided(claim: Claim, comparisons: Sequence[Comparison], extrapolated: bool) -> str:
    """The comparisons behind a verdict, in words."""
    samples = fewest_samples(comparisons)
    where = f" at {share(claim, samples)}" if samples < samples_of_text(claim) else ""
    where = " at the thesis's samples, extrapolated" if extrapolated else where
    if any(each.seeds == 1 for each in comparisons):
        where += ", of one training"
    supporting, opposing = sum(each.supports for each in comparisons), against(comparisons)
    if supporting < len(comparisons) and opposing:
        return f"against the claim{where}: {'; '.join(each.text for each in opposing)}"
    rest = ", none is against it by Holm's correction" if supporting < len(comparisons) else ""
    return f"{supporting} of {len(comparisons)} comparisons are in its favour{where}{rest}"


def deciding(comparisons: Sequence[Comparison]) -> Comparison:
    """The first comparison without support, preferably with learning curves."""
    return min(comparisons, key=lambda each: (each.learning is None, each.supports))


def direction_of(comparisons: Sequence[Comparison]) -> str:
    """The common direction of comparisons, if they have one.

    Only those without support count, if any.
    """
    unsupported = [each for each in comparisons if not each.supports] or comparisons
    directions = {each.learning.direction if each.learning else "" for each in unsupported}
    return directions.pop() if len(directions) == 1 else ""


def trend_of(comparisons: Sequence[Comparison]) -> dict[str, Any]:
    """The trend of the `deciding` comparison, or NaN."""
    shown = deciding(comparisons)
    ends = shown.learning.trend if shown.learning else [np.nan] * 3
    finite = [end if np.isfinite(end) else np.nan for end in ends]
    return {
        "trend_of": f"{shown.metric} of {shown.methods}" if shown.learning else "",
        **dict(zip(("trend", "trend_low", "trend_high"), finite)),
        "direction": shown.learning.direction if shown.learning else "",
    }
