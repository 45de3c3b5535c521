"""The tests of a claim in their order: the first that it fails is its verdict."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from neural_shadows.metrics.power_law import LARGEST_STEP
from neural_shadows.reports import verdicts
from neural_shadows.reports.claims import better, frame_time, lower_loss, printed, violations
from neural_shadows.reports.claims.comparison import Comparison, against, verdict_of
from neural_shadows.reports.claims.learning import AWAY, NEITHER, TOWARDS, Learning
from neural_shadows.reports.claims.measured import THESIS_SAMPLES, Measured, rows_of
from neural_shadows.reports.claims.unlearned import not_learned

KINDS = {
    "better": better.comparisons,
    "lower_loss": lower_loss.comparisons,
    "frame_time": frame_time.comparisons,
    "violations": violations.comparisons,
    "printed": printed.comparisons,
}
OF_TRAININGS = ("better", "lower_loss")
# One training says nothing of how trainings differ. Two are enough for an interval, of Student's t
# with one degree of freedom: 12.7 standard errors either way.
LEAST_SEEDS = 2
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
    null = null_verdict(claim, data)
    extrapolated = [one.extrapolated for one in found]
    carried = below_budget(claim, found) and all(extrapolated)
    final = extrapolated if carried else found
    gates = {
        verdicts.NOT_COMPARABLE: not_comparable(claim, data),
        verdicts.NOT_LEARNED: not_learned(claim, data),
        verdicts.VACUOUS: vacuous(final, null),
        verdicts.TOO_SMALL: too_small(claim, found, carried),
        verdict_of(final): decided(final, carried),
    }
    verdict, reason = next((verdict, reason) for verdict, reason in gates.items() if reason)
    samples = [one.samples for one in found if one.samples is not None]
    return {
        "verdict": verdict,
        "reason": reason,
        "metric": ", ".join(dict.fromkeys(one.metric for one in found)),
        "seeds": min((one.seeds for one in found if one.seeds is not None), default=np.nan),
        "budget_fraction": min(samples, default=np.nan) / THESIS_SAMPLES,
        **trend_of(found),
        "null_verdict": null,
        "evidence": "; ".join(one.evidence for one in found),
        "samples": min(samples, default=np.nan),
    }


def not_comparable(claim: Claim, data: Measured) -> str:
    """Why what was measured is not what the claim is about; empty if it is."""
    if needs(claim, "mesh") == "thesis":
        scenes = dict.fromkeys(row["scene"] for row in rows_of(claim))
        own = {
            s for s in scenes if data.meshes[s]["thesis_mesh"] and not data.scenes[s]["procedural"]
        }
        if others := [scene for scene in scenes if scene not in own]:
            return f"not the thesis's mesh: {', '.join(others)}"
    if claim["kind"] == "frame_time":
        found, asked = frame_time.devices(claim, data), needs(claim, "device")
        if len({*found.values(), asked or min(found.values())}) > 1:
            timed = ", ".join(f"{label} on {device}" for label, device in found.items())
            return f"times of {asked or 'one device'} are needed: {timed}"
    return ""


def null_verdict(claim: Claim, data: Measured) -> str:
    """The verdict with no shadow in place of the networks; empty where it can have none."""
    if claim["kind"] != "better" or not any(map(data.trained, rows_of(claim))):
        return ""
    return verdict_of(better.without_networks(claim, data))


def vacuous(found: Sequence[Comparison], null: str) -> str:
    """Why a support says nothing; empty if it does, or if there is no support."""
    if null == verdict_of(found) == verdicts.SUPPORTED:
        return "supported as well with no shadow in place of the networks"
    return ""


def below_budget(claim: Claim, found: Sequence[Comparison]) -> bool:
    """Whether a network saw a smaller share of the thesis's samples than the claim needs."""
    least = (needs(claim, "budget") or 0.0) * THESIS_SAMPLES
    return any(one.samples < least for one in found if one.samples is not None)


def too_small(claim: Claim, found: Sequence[Comparison], carried: bool) -> str:
    """What seeds or samples are missing, and where the difference goes; empty if none are."""
    trained = [one for one in found if one.samples is not None]
    asked = max(needs(claim, "seeds") or 0, LEAST_SEEDS * (claim["kind"] in OF_TRAININGS))
    learning = deciding_curves(found)
    reasons = []
    if trained and (seeds := min(one.seeds for one in trained)) < asked:
        reasons.append(f"{seeds} seed{'s' if seeds > 1 else ''} of {asked}")
    if below_budget(claim, found) and not carried:
        least, budget = min(one.samples for one in trained), needs(claim, "budget")
        deciding = min(budget, 1 / LARGEST_STEP) * THESIS_SAMPLES
        reasons.append(
            f"{share(least)}, {100 * budget:.3g} % are needed "
            f"({deciding / 1e9:.2g} billion a network)"
        )
        if learning and learning.unlicensed:
            reasons.append(f"no extrapolation: {learning.unlicensed}")
    if reasons and learning and learning.direction:
        reasons.append(MOVING[learning.direction])
    return "; ".join(reasons)


def share(samples: int) -> str:
    """Training samples of a network in words."""
    return f"{100 * samples / THESIS_SAMPLES:.2g} % of the thesis's samples"


def decided(found: Sequence[Comparison], carried: bool) -> str:
    """Which comparisons a verdict rests on."""
    samples = min((one.samples for one in found if one.samples is not None), default=THESIS_SAMPLES)
    where = f" at {share(samples)}" if samples < THESIS_SAMPLES else ""
    where = " at the thesis's samples, extrapolated" if carried else where
    held, lost = sum(one.supports for one in found), against(found)
    if held < len(found) and lost:
        return f"against it{where}: {'; '.join(one.text for one in lost)}"
    rest = ", none is against it" if held < len(found) else ""
    return f"{held} of {len(found)} comparisons are in its favour{where}{rest}"


def deciding_curves(found: Sequence[Comparison]) -> Learning | None:
    """The learning curves of the first comparison that does not support a claim, else the first."""
    learnt = sorted((one for one in found if one.learning), key=lambda one: one.supports)
    return learnt[0].learning if learnt else None


def trend_of(found: Sequence[Comparison]) -> dict[str, Any]:
    """The trend and its direction by `deciding_curves`; NaN and empty where there is none."""
    learning = deciding_curves(found)
    ends = learning.trend if learning else [np.nan] * 3
    known = [end if np.isfinite(end) else np.nan for end in ends]
    names = dict(zip(("trend", "trend_low", "trend_high"), known))
    return {**names, "direction": learning.direction if learning else ""}


def needs(claim: Claim, name: str) -> Any:
    """What a claim needs of the data, None for no need."""
    return (claim.get("needs") or {}).get(name)
