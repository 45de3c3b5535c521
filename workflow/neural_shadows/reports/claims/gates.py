"""The tests of a claim in their order: the first that it fails is its verdict."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from neural_shadows.metrics.power_law import LARGEST_STEP
from neural_shadows.reports import verdicts
from neural_shadows.reports.claims import (
    better,
    frame_time,
    lower_loss,
    printed,
    proportional,
    ratio,
    soft,
    violations,
)
from neural_shadows.reports.claims.comparison import (
    NAMES,
    Comparison,
    against,
    most_against,
    verdict_of,
)
from neural_shadows.reports.claims.learning import AWAY, NEITHER, TOWARDS
from neural_shadows.reports.claims.measured import TEXT_SAMPLES, Measured, rows_of
from neural_shadows.reports.claims.unlearned import not_learned
from neural_shadows.reports.phrases import TEXTS, is_own_mesh
from neural_shadows.reports.tables.frame_means import OFF_EDGES

KINDS = {
    "better": better.comparisons,
    "lower_loss": lower_loss.comparisons,
    "frame_time": frame_time.comparisons,
    "violations": violations.comparisons,
    "printed": printed.comparisons,
    "soft_better": soft.better,
    "soft_equal_time": soft.equal_time,
    "ratio": ratio.comparisons,
    "proportional": proportional.comparisons,
}
# Of the other kinds what learns nothing has no part in a claim, or none that is known: who breaks no
# bound of depth, or one alone, has nothing to be compared (violations).
WITHOUT_NETWORKS = {
    "better": better.without_networks,
    "lower_loss": lower_loss.without_networks,
    "soft_better": soft.without_networks,
    "soft_equal_time": soft.without_networks,
    "ratio": ratio.without_networks,
}
OF_TRAININGS = ("better", "lower_loss")
# One training says nothing of how trainings differ. Two are enough for an interval, of Student's t
# with one degree of freedom: 12.7 standard errors either way.
LEAST_SEEDS = 2
# Of a smaller share of a text's samples nothing may be extrapolated, so that nothing is known of these.
DECISIVE = 1 / LARGEST_STEP
WHOSE = {"thesis": "the thesis's samples"} | {
    name: f"{paper}'s pixels" for name, paper in TEXTS.items()
}
MOVING = {
    TOWARDS: "moving towards the claim",
    AWAY: "moving away from the claim",
    NEITHER: "moving neither towards the claim nor away",
}

Claim = Mapping[str, Any]


def judge(claim: Claim, data: Measured) -> dict[str, Any]:
    """Test a claim: the columns of claims.csv from `verdict` to `evidence`.

    `claim` has `kind`, `needs` (`mesh`, `device`, `seeds` and `budget`, each may be missing or
    None) and what its kind needs; its methods are rows as `config.rows_of` gives them.
    """
    found = KINDS[claim["kind"]](claim, data)
    if pixels := data.pixels(claim):
        found = [replace(one, samples=pixels) for one in found]
    null, passing = null_verdict(claim, data)
    carried = carried_on(claim, found)
    final = carried or found
    gates = {
        verdicts.NOT_COMPARABLE: not_comparable(claim, found, data),
        verdicts.NOT_LEARNED: not_learned(claim, data),
        verdicts.VACUOUS: vacuous(claim, final, passing),
        verdicts.TOO_SMALL: too_small(claim, found, carried),
        verdict_of(final): decided(claim, final, bool(carried)),
    }
    verdict, reason = next((verdict, reason) for verdict, reason in gates.items() if reason)
    samples = [one.samples for one in found if one.samples is not None]
    shown = most_against(final)
    evidence = "\n".join(one.evidence for one in found)
    if (other := by_all_pixels(claim)) and (unlike := judge(other, data)["verdict"]) != verdict:
        evidence += f". By the error of all pixels, edges of surfaces among them: {unlike}"
    return {
        "verdict": verdict,
        "reason": reason,
        "metric": ", ".join(dict.fromkeys(one.metric for one in found)),
        "seeds": min((one.seeds for one in found if one.seeds is not None), default=np.nan),
        "budget_fraction": min(samples, default=np.nan) / whole_of(claim),
        **trend_of(found),
        "null_verdict": null,
        "number_of": NAMES.get(shown.metric, shown.metric) if shown else "",
        "number": shown.number if shown else "",
        "evidence": evidence,
        "samples": min(samples, default=np.nan),
        "text_samples": whole_of(claim),
    }


def whole_of(claim: Claim) -> int:
    """What a network of a claim's text was trained on."""
    return TEXT_SAMPLES[claim.get("text", "thesis")]


def by_all_pixels(claim: Claim) -> Claim | None:
    """The claim on errors of all pixels; None of one that is not on those off edges."""
    end = OFF_EDGES.removeprefix("mse")
    if claim["kind"] == "soft_equal_time" and "metric" not in claim:
        return {**claim, "metric": "mse"}
    if claim["kind"] == "soft_better" and OFF_EDGES in claim["metrics"]:
        return {**claim, "metrics": [name.removesuffix(end) for name in claim["metrics"]]}
    columns = [one["column"] for one in claim.get("ratios", ())]
    if any(column.endswith(end) for column in columns):
        ratios = [one | {"column": one["column"].removesuffix(end)} for one in claim["ratios"]]
        return {**claim, "ratios": ratios}
    return None


def not_comparable(claim: Claim, found: Sequence[Comparison], data: Measured) -> str:
    """Why what was measured is not what the claim is about; empty if it is."""
    if needs(claim, "mesh") == "thesis":
        scenes = dict.fromkeys(row["scene"] for row in rows_of(claim))
        if others := [s for s in scenes if not is_own_mesh(data.meshes[s], data.scenes[s])]:
            return f"not the thesis's mesh: {', '.join(others)}"
    if claim["kind"] == "frame_time":
        timed, asked = frame_time.devices(claim, data), needs(claim, "device")
        if len({*timed.values(), asked or min(timed.values())}) > 1:
            said = ", ".join(f"{label} on {device}" for label, device in timed.items())
            return f"times of {asked or 'one device'} are needed: {said}"
    said = {one.methods: one.incomparable for one in found if one.incomparable}
    return "; ".join(f"{methods}: {why}" for methods, why in said.items())


def null_verdict(claim: Claim, data: Measured) -> tuple[str, str]:
    """The verdict with what learns nothing in the networks' place, and what of it is supported.

    Both are empty where it has no place.
    """
    nulls = WITHOUT_NETWORKS.get(claim["kind"], lambda *_: {})(claim, data)
    verdicts_of = {null: verdict_of(found) for null, found in nulls.items()}
    passing = [null for null, verdict in verdicts_of.items() if verdict == verdicts.SUPPORTED]
    if passing:
        return verdicts.SUPPORTED, " and ".join(passing).replace("_", " ")
    return next(iter(verdicts_of.values()), ""), ""


def vacuous(claim: Claim, found: Sequence[Comparison], passing: str) -> str:
    """Why a support says nothing; empty if it does, or if there is no support.

    Any map beats no shadow, so that this says nothing against a claim that maps beat a network, if
    the network has learned what it can: from a thirtieth of its text's samples on it counts.

    Args:
        passing: what learns nothing and is supported in the networks' place.
    """
    if not passing or verdict_of(found) != verdicts.SUPPORTED:
        return ""
    if network_wins(claim):
        return f"supported as well with {passing} in place of the networks"
    if (least := fewest_samples(found)) < DECISIVE * whole_of(claim):
        return (
            f"{passing} in the networks' place loses as well, and they do at {share(claim, least)}"
        )
    return ""


def network_wins(claim: Claim) -> bool:
    """Whether a network that learns is to be better than something."""
    if claim["kind"] == "better":
        return any(winner["trained"] for winner, _ in claim["pairs"])
    return claim["kind"] in ("lower_loss", "ratio") or soft.wins(claim)


def carried_on(claim: Claim, found: Sequence[Comparison]) -> list[Comparison]:
    """The comparisons, those of fewer samples than a claim needs at the thesis's.

    Empty if none has fewer, or if one's learning curves do not license it.
    """
    short = [below_budget(claim, one) for one in found]
    carried = [one.extrapolated if few else one for one, few in zip(found, short)]
    return carried if any(short) and all(carried) else []


def below_budget(claim: Claim, one: Comparison) -> bool:
    """Whether its networks saw a smaller share of the thesis's samples than the claim needs."""
    least = (needs(claim, "budget") or 0.0) * whole_of(claim)
    return one.samples is not None and one.samples < least


def fewest_samples(found: Sequence[Comparison]) -> float:
    """Of the trainings of comparisons; infinite if nothing is trained."""
    return min((one.samples for one in found if one.samples is not None), default=np.inf)


def too_small(claim: Claim, found: Sequence[Comparison], carried: Sequence[Comparison]) -> str:
    """What seeds, views or samples are missing, and where the difference goes; empty if none are."""
    trained = [one for one in found if one.samples is not None]
    asked = max(needs(claim, "seeds") or 0, LEAST_SEEDS * (claim["kind"] in OF_TRAININGS))
    learning = deciding(found).learning
    lost = against(carried or found)
    # One comparison is enough against a claim, whatever the others lack.
    reasons = [] if lost else [*dict.fromkeys(one.untested for one in found if one.untested)]
    seeds = min((one.seeds for one in trained if one.seeds is not None), default=asked)
    if seeds < asked:
        reasons.append(f"{seeds} seed{'s' if seeds > 1 else ''} of {asked}")
    if any(below_budget(claim, one) for one in found) and not carried:
        least, budget = fewest_samples(found), needs(claim, "budget")
        reasons.append(f"{share(claim, least)}, {100 * budget:.3g} % are needed")
        if least < (enough := DECISIVE * whole_of(claim)):
            reasons.append(
                f"an extrapolation needs 1/{LARGEST_STEP}: {enough / 1e9:.2g} billion a network"
            )
        if learning and learning.unlicensed:
            reasons.append(f"no extrapolation: {learning.unlicensed}")
    elif (least := fewest_samples(lost)) < DECISIVE * whole_of(claim):
        reasons.append(f"against the claim at {share(claim, least)}, which says nothing of more")
    if reasons and (moving := direction_of(found)):
        reasons.append(MOVING[moving])
    return "; ".join(reasons)


def share(claim: Claim, samples: float) -> str:
    """Training samples of a network in words."""
    whose = WHOSE[claim.get("text", "thesis")]
    return f"{100 * samples / whole_of(claim):.2g} % of {whose}"


def decided(claim: Claim, found: Sequence[Comparison], carried: bool) -> str:
    """Which comparisons a verdict rests on."""
    samples = fewest_samples(found)
    where = f" at {share(claim, samples)}" if samples < whole_of(claim) else ""
    where = " at the thesis's samples, extrapolated" if carried else where
    if any(one.seeds == 1 for one in found):
        where += ", of one training"
    held, lost = sum(one.supports for one in found), against(found)
    if held < len(found) and lost:
        return f"against the claim{where}: {'; '.join(one.text for one in lost)}"
    rest = ", none is significantly against it" if held < len(found) else ""
    return f"{held} of {len(found)} comparisons are in its favour{where}{rest}"


def deciding(found: Sequence[Comparison]) -> Comparison:
    """The first comparison with learning curves that does not support a claim, else the first."""
    return min(found, key=lambda one: (one.learning is None, one.supports))


def direction_of(found: Sequence[Comparison]) -> str:
    """Where a claim's comparisons move, of those that do not support it if there are some.

    Empty if they do not all move alike, or if that is not known of one.
    """
    open_ones = [one for one in found if not one.supports] or found
    directions = {one.learning.direction if one.learning else "" for one in open_ones}
    return directions.pop() if len(directions) == 1 else ""


def trend_of(found: Sequence[Comparison]) -> dict[str, Any]:
    """The trend of the `deciding` comparison and which it is; NaN and empty where there is none."""
    one = deciding(found)
    ends = one.learning.trend if one.learning else [np.nan] * 3
    known = [end if np.isfinite(end) else np.nan for end in ends]
    return {
        "trend_of": f"{one.metric} of {one.methods}" if one.learning else "",
        **dict(zip(("trend", "trend_low", "trend_high"), known)),
        "direction": one.learning.direction if one.learning else "",
    }


def needs(claim: Claim, name: str) -> Any:
    """What a claim needs of the data, None for no need."""
    return (claim.get("needs") or {}).get(name)
