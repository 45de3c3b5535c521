"""A claim's tests, of which the first failed one decides."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from neural_shadows.metrics.power_law import LARGEST_STEP
from neural_shadows.reports.claims.claim_kinds import by_kind, kind_of, methods
from neural_shadows.reports.claims.comparison import (
    NAMES,
    Comparison,
    against,
    most_against,
    seeds_of,
    verdict_of,
)
from neural_shadows.reports.claims.learning import AWAY, NEITHER, TOWARDS
from neural_shadows.reports.claims.measured import TEXT_SAMPLES, Claim, Measured, needs
from neural_shadows.reports.claims.unlearned import not_learned
from neural_shadows.reports.data import verdicts
from neural_shadows.reports.data.phrases import TEXTS, is_own_mesh

# One training says nothing of how trainings differ. Two are enough for an interval, of Student's t
# with one degree of freedom: 12.7 standard errors either way.
LEAST_SEEDS = 2
# Of a smaller share of a text's samples nothing may be extrapolated, so that they decide nothing.
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
    """Test a claim, as its kind's `Settings.resolved` gives it.

    Returns: the columns of claims.csv from `verdict` to `text_samples`.
    """
    comparisons = kind_of(claim).comparisons(claim, data)
    if pixels := data.pixels(claim):
        comparisons = [replace(each, samples=pixels) for each in comparisons]
    null, passing = null_verdict(claim, data)
    carried = carried_on(claim, comparisons)
    final = carried or comparisons
    gates = {
        verdicts.NOT_COMPARABLE: not_comparable(claim, comparisons, data),
        verdicts.NOT_LEARNED: not_learned(claim, data),
        verdicts.VACUOUS: vacuous(claim, final, passing),
        verdicts.TOO_SMALL: too_small(claim, comparisons, carried),
        verdict_of(final): decided(claim, final, bool(carried)),
    }
    verdict, reason = next((verdict, reason) for verdict, reason in gates.items() if reason)
    seeds = [each.seeds for each in comparisons if each.seeds is not None]
    samples = [each.samples for each in comparisons if each.samples is not None]
    shown = most_against(final)
    evidence = "\n".join(each.evidence for each in comparisons)
    other = by_kind(claim, "by_all_pixels", default=None)
    if other and (unlike := judge(other, data)["verdict"]) != verdict:
        evidence += f". By the error of all pixels, edges of surfaces among them: {unlike}"
    return {
        "verdict": verdict,
        "reason": reason,
        "metric": ", ".join(dict.fromkeys(each.metric for each in comparisons)),
        "seeds": min(seeds, default=np.nan),
        "budget_fraction": min(samples, default=np.nan) / whole_of(claim),
        **trend_of(comparisons),
        "null_verdict": null,
        "number_of": NAMES.get(shown.metric, shown.metric) if shown else "",
        "number": shown.number if shown else "",
        "evidence": evidence,
        "samples": min(samples, default=np.nan),
        "text_samples": whole_of(claim),
    }


def whole_of(claim: Claim) -> int:
    """Training samples of networks of a claim's text."""
    return TEXT_SAMPLES[claim.get("text", "thesis")]


def not_comparable(claim: Claim, comparisons: Sequence[Comparison], data: Measured) -> str:
    """The reason against comparable measurements, if any."""
    if needs(claim, "mesh") == "thesis":
        scenes = dict.fromkeys(row["scene"] for row in methods(claim))
        if others := [s for s in scenes if not is_own_mesh(data.meshes[s], data.scenes[s])]:
            return f"not the thesis's mesh: {', '.join(others)}"
    if why := by_kind(claim, "not_comparable", data, default=""):
        return why
    reasons = {each.methods: each.incomparable for each in comparisons if each.incomparable}
    return "; ".join(f"{compared}: {why}" for compared, why in reasons.items())


def null_verdict(claim: Claim, data: Measured) -> tuple[str, str]:
    """The verdict with null predictors for networks, and supported ones.

    Both are empty where null predictors have no place.
    """
    nulls = by_kind(claim, "without_networks", data, default={})
    verdicts_of = {null: verdict_of(comparisons) for null, comparisons in nulls.items()}
    passing = [null for null, verdict in verdicts_of.items() if verdict == verdicts.SUPPORTED]
    if passing:
        return verdicts.SUPPORTED, " and ".join(passing).replace("_", " ")
    return next(iter(verdicts_of.values()), ""), ""


def vacuous(claim: Claim, comparisons: Sequence[Comparison], passing: str) -> str:
    """The reason for a vacuous support, if it is one.

    Any map beats no shadow, so that this says nothing against a claim that maps beat a network, if
    the network has learned what it can: from a thirtieth of its text's samples on it counts.

    Args:
        passing: the null predictors that are supported in the networks' place.
    """
    if not passing or verdict_of(comparisons) != verdicts.SUPPORTED:
        return ""
    if by_kind(claim, "network_wins", default=True):
        return f"supported as well with {passing} in place of the networks"
    if (least := fewest_samples(comparisons)) < DECISIVE * whole_of(claim):
        return (
            f"{passing} in the networks' place loses as well, and they do at {share(claim, least)}"
        )
    return ""


def carried_on(claim: Claim, comparisons: Sequence[Comparison]) -> list[Comparison]:
    """The comparisons, those of too few samples extrapolated.

    Empty if all have as many as the claim needs, or if one's learning curves license nothing.
    """
    short = [below_budget(claim, each) for each in comparisons]
    carried = [each.extrapolated if few else each for each, few in zip(comparisons, short)]
    return carried if any(short) and all(carried) else []


def below_budget(claim: Claim, comparison: Comparison) -> bool:
    """Check for a smaller share of the samples than needed."""
    least = (needs(claim, "budget") or 0.0) * whole_of(claim)
    return comparison.samples is not None and comparison.samples < least


def fewest_samples(comparisons: Sequence[Comparison]) -> float:
    """The fewest training samples; infinite if nothing is trained."""
    samples = [each.samples for each in comparisons if each.samples is not None]
    return min(samples, default=np.inf)


def too_small(
    claim: Claim, comparisons: Sequence[Comparison], carried: Sequence[Comparison]
) -> str:
    """Missing seeds, views or samples, and the difference's direction."""
    least_seeds = LEAST_SEEDS * getattr(kind_of(claim), "NEEDS_SEEDS", False)
    needed = max(needs(claim, "seeds") or 0, least_seeds)
    learning = deciding(comparisons).learning
    lost = against(carried or comparisons)
    # One comparison is enough against a claim, whatever the others lack.
    untested = dict.fromkeys(each.untested for each in comparisons if each.untested)
    reasons = [] if lost else [*untested]
    trained = [each for each in comparisons if each.samples is not None]
    seeds = min((each.seeds for each in trained if each.seeds is not None), default=needed)
    if seeds < needed:
        reasons.append(seeds_of(seeds, needed))
    if any(below_budget(claim, each) for each in comparisons) and not carried:
        least, budget = fewest_samples(comparisons), needs(claim, "budget")
        reasons.append(f"{share(claim, least)}, {100 * budget:.3g} % are needed")
        if least < (enough := DECISIVE * whole_of(claim)):
            reasons.append(
                f"an extrapolation needs 1/{LARGEST_STEP}: {enough / 1e9:.2g} billion a network"
            )
        if learning and learning.unlicensed:
            reasons.append(f"no extrapolation: {learning.unlicensed}")
    elif (least := fewest_samples(lost)) < DECISIVE * whole_of(claim):
        reasons.append(f"against the claim at {share(claim, least)}, which says nothing of more")
    if reasons and (moving := direction_of(comparisons)):
        reasons.append(MOVING[moving])
    return "; ".join(reasons)


def share(claim: Claim, samples: float) -> str:
    """Training samples of a network in words."""
    whose = WHOSE[claim.get("text", "thesis")]
    return f"{100 * samples / whole_of(claim):.2g} % of {whose}"


def decided(claim: Claim, comparisons: Sequence[Comparison], carried: bool) -> str:
    """The comparisons behind a verdict, in words."""
    samples = fewest_samples(comparisons)
    where = f" at {share(claim, samples)}" if samples < whole_of(claim) else ""
    where = " at the thesis's samples, extrapolated" if carried else where
    if any(each.seeds == 1 for each in comparisons):
        where += ", of one training"
    held, lost = sum(each.supports for each in comparisons), against(comparisons)
    if held < len(comparisons) and lost:
        return f"against the claim{where}: {'; '.join(each.text for each in lost)}"
    rest = ", none is significantly against it" if held < len(comparisons) else ""
    return f"{held} of {len(comparisons)} comparisons are in its favour{where}{rest}"


def deciding(comparisons: Sequence[Comparison]) -> Comparison:
    """The first comparison without support, those with learning curves before."""
    return min(comparisons, key=lambda each: (each.learning is None, each.supports))


def direction_of(comparisons: Sequence[Comparison]) -> str:
    """The common direction of comparisons, if they have one.

    Those without support count alone, if there are some.
    """
    open_ones = [each for each in comparisons if not each.supports] or comparisons
    directions = {each.learning.direction if each.learning else "" for each in open_ones}
    return directions.pop() if len(directions) == 1 else ""


def trend_of(comparisons: Sequence[Comparison]) -> dict[str, Any]:
    """The trend of the `deciding` comparison, NaN without one."""
    shown = deciding(comparisons)
    ends = shown.learning.trend if shown.learning else [np.nan] * 3
    finite = [end if np.isfinite(end) else np.nan for end in ends]
    return {
        "trend_of": f"{shown.metric} of {shown.methods}" if shown.learning else "",
        **dict(zip(("trend", "trend_low", "trend_high"), finite)),
        "direction": shown.learning.direction if shown.learning else "",
    }
