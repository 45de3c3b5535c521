"""Which networks of a claim have learned nothing: they are not better than what knows nothing."""

from collections.abc import Mapping
from typing import Any

from neural_shadows.evaluation.method_names import NO_SHADOW
from neural_shadows.metrics.intervals import FEWEST_VIEWS
from neural_shadows.reports.claims.comparison import NAMES, interval_text
from neural_shadows.reports.claims.measured import (
    WITHOUT_ROWS,
    Budget,
    Measured,
    Row,
    compared,
    networks_of_frames,
)
from neural_shadows.reports.digits import short
from neural_shadows.reports.learned import THESIS_METRICS, has_learned, learned

LOSS_MARGIN = 0.02  # of no shadow's loss: what chance does to the end of a curve


def not_learned(claim: Mapping[str, Any], data: Measured) -> str:
    """Which trained networks are not better than what knows nothing; empty if all are.

    Networks of frames must be better than the best of no shadow, the hard map and their own base, by
    the squared error on validation frames. Of others each training of the budget that is compared
    must be better than drawing no shadow, in the metrics of the thesis's tables and those of the
    claim, or in its loss. Of too few views nothing is said.
    """
    if networks := networks_of_frames(claim):
        return "; ".join(filter(None, (_by_validation(name, data) for name in networks)))
    if claim["kind"] in ("frame_time", *WITHOUT_ROWS):
        return ""  # none is about what a network answers
    tested = [
        (row, budget)
        for rows in compared(claim)
        for budget in data.budgets(rows)[-1:]
        for row in rows
        if row["trained"]
    ]
    said = {}
    for row, budget in tested:
        if claim["kind"] == "lower_loss":
            reason = _by_loss(row, row["method"] in losers(claim), budget, data)
        else:
            names = dict.fromkeys((*THESIS_METRICS, *claim.get("metrics", ())))
            reason = _by_frames(row, [*names], budget, data)
        if reason:
            said[row["method"]] = f"{row['label']} ({row['scene']}): {reason}"
    return "; ".join(said.values())


def _by_validation(name: str, data: Measured) -> str:
    """Why a network died or is not better on validation frames than the best of no shadow, the hard
    map and its own base, over all lights that it learned.
    """
    record = data.screen_trainings[name]
    if record["died_at_step"] is not None:
        return f"{name}: died at step {record['died_at_step']:,}"
    lights = record.get("training", {}).get("lights") or range(len(record["validation_mse"]))
    errors, nulls = record["validation_mse"], record["null_mse"]
    errors = [errors[light] for light in lights]
    nulls = {null: sum(each[light] for light in lights) for null, each in nulls.items()}
    least = min(nulls, key=nulls.get)
    if None in errors:
        return f"{name}: its answers are no numbers"
    if sum(errors) < nulls[least]:
        return ""
    ours, theirs = (1e4 * total / len(errors) for total in (sum(errors), nulls[least]))
    return f"{name}: MSE {short(ours)} × 10⁻⁴ on validation frames, {least} {short(theirs)}"


def losers(claim: Mapping[str, Any]) -> set[str]:
    """The methods that a claim says are worse than others, and not better than any."""
    first, second = zip(*claim["pairs"])
    return {row["method"] for row in second} - {row["method"] for row in first}


def _by_frames(row: Row, names: list[str], budget: Budget, data: Measured) -> str:
    """The first metric in which a training is not better, beyond the thesis's run-to-run margin."""
    metrics = [*dict.fromkeys(data.metric(row, name) for name in names)]
    frames = data.metrics[row["scene"]]
    if len(frames) < FEWEST_VIEWS:
        return ""
    for method in data.methods(row, budget):
        found = learned(frames[method], frames[NO_SHADOW], metrics, data.margins, data.seed)
        if not has_learned(found):
            metric = next(name for name, (_, low, _) in found.items() if not low > 0)
            numbers, margin = interval_text(*found[metric]), data.margins.get(metric, 0.0)
            return f"{NAMES[metric]} beats no shadow by {numbers} beyond the margin {margin:.2g}"
    return ""


def _by_loss(row: Row, loser: bool, budget: Budget, data: Measured) -> str:
    """The first training whose loss ends no lower than that of drawing no shadow, or that died.

    A training that died in a claimed loser's place is what such a claim is about, a rate that is
    too high for instance, and no reason to say nothing.
    """
    for run, loss in zip(budget.runs[row["experiment"]], data.end_losses(row, budget)):
        record = data.trainings[run]
        died, null = record["died_at_step"], record["no_shadow_loss"]
        if died is not None:
            if not loser:
                return f"died at step {died:,}"
        elif loss >= (1 - LOSS_MARGIN) * null:
            return f"loss {short(loss)}, without shadow {short(null)} (margin {100 * LOSS_MARGIN:.0f} %)"
    return ""
