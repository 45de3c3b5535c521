"""Which networks of a claim have learned nothing: they are not better than drawing no shadow."""

from collections.abc import Mapping
from typing import Any

from neural_shadows.reports.claims.comparison import NAMES, interval_text
from neural_shadows.reports.claims.measured import NO_SHADOW, Measured, Row, rows_of
from neural_shadows.reports.learned import has_learned, learned

THESIS_METRICS = ("lpips", "psnr", "ssim")  # of its tables: what a network must be better in


def not_learned(claim: Mapping[str, Any], data: Measured) -> str:
    """Which trained networks are not better than drawing no shadow; empty if all are.

    Each training of the largest budget must be, in each of the claim's metrics.
    """
    if claim["kind"] in ("frame_time", "printed"):
        return ""  # neither is about what a network answers
    said = []
    for row in {row["method"]: row for row in rows_of(claim) if data.trained(row)}.values():
        if claim["kind"] == "lower_loss":
            reason = _by_loss(row, row["method"] in losers(claim), data)
        else:
            reason = _by_frames(row, claim.get("metrics", THESIS_METRICS), data)
        if reason:
            said.append(f"{row['label']} ({row['scene']}): {reason}")
    return "; ".join(said)


def losers(claim: Mapping[str, Any]) -> set[str]:
    """The methods that a claim says are worse than others, and not better than any."""
    first, second = zip(*claim["pairs"])
    return {row["method"] for row in second} - {row["method"] for row in first}


def _by_frames(row: Row, names: list[str], data: Measured) -> str:
    """The first metric in which a training is not better, beyond the thesis's run-to-run margin."""
    metrics = [data.metric(row, name) for name in names]
    frames = data.metrics[row["scene"]]
    null = frames[NO_SHADOW["method"]][metrics]
    for method in data.methods(row, data.budgets([row])[-1]):
        found = learned(frames[method][metrics], null, metrics, data.margins, data.seed)
        if not has_learned(found):
            metric = next(name for name, (_, low, _) in found.items() if not low > 0)
            numbers, margin = interval_text(*found[metric]), data.margins.get(metric, 0.0)
            return f"{NAMES[metric]} beats no shadow by {numbers} beyond the margin {margin:.2g}"
    return ""


def _by_loss(row: Row, loser: bool, data: Measured) -> str:
    """The first training whose loss ends no lower than that of drawing no shadow.

    A training that died in a claimed loser's place is what such a claim is about, a rate that is
    too high for instance, and no reason to say nothing.
    """
    budget = data.budgets([row])[-1]
    for run, loss in zip(budget.runs[row["experiment"]], data.end_losses(row, budget)):
        record = data.trainings[run]
        died = record.get("died_at_step") is not None
        if loss >= record["no_shadow_loss"] and not (died and loser):
            return f"loss {loss:.3g}, without shadow {record['no_shadow_loss']:.3g}"
    return ""
