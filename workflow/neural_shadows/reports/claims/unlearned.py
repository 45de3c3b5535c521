"""Networks of claims no better than null predictors."""

from neural_shadows.evaluation.null_predictors import NO_SHADOW
from neural_shadows.metrics.intervals import FEWEST_VIEWS
from neural_shadows.reports.claims.claim_kinds import compared, kind_of
from neural_shadows.reports.claims.comparison import NAMES, interval_text
from neural_shadows.reports.claims.measured import Claim, Measured, trained_screen_networks
from neural_shadows.reports.data.digits import short
from neural_shadows.reports.data.learned import THESIS_METRICS, has_learned, learned
from neural_shadows.reports.data.trained import Budget, Row


def not_learned(claim: Claim, data: Measured) -> str:
    """Name the trained networks no better than null predictors.

    Screen-space networks must be better than no shadow, the hard map and their own base, by the
    squared error on validation frames. Of others each training of the compared budget must
    be better than no shadow, in the metrics of the thesis's tables and of the claim, or in its
    loss. Too few views decide nothing.
    """
    if networks := trained_screen_networks(claim):
        return "; ".join(filter(None, (_by_validation(name, data) for name in networks)))
    kind = kind_of(claim)
    if not hasattr(kind, "not_learned"):
        return ""
    trained = [
        (row, budget)
        for rows in compared(claim)
        for budget in data.budgets(rows)[-1:]
        for row in rows
        if row["trained"]
    ]
    reasons = {}
    for row, budget in trained:
        if reason := kind.not_learned(claim, row, budget, data):
            reasons[row["method"]] = f"{row['label']} ({row['scene']}): {reason}"
    return "; ".join(reasons.values())


def by_frames(claim: Claim, row: Row, budget: Budget, data: Measured) -> str:
    """The first metric no better than no shadow's.

    Differences count beyond the thesis's run-to-run margin.
    """
    names = dict.fromkeys((*THESIS_METRICS, *claim.get("metrics", ())))
    metrics = [*dict.fromkeys(data.metric(row, name) for name in names)]
    frames = data.metrics[row["scene"]]
    if len(frames) < FEWEST_VIEWS:
        return ""
    for method in data.methods(row, budget):
        gains = learned(frames[method], frames[NO_SHADOW], metrics, data.margins, data.seed)
        if not has_learned(gains):
            metric = next(name for name, (_, low, _) in gains.items() if not low > 0)
            numbers, margin = interval_text(*gains[metric]), data.margins.get(metric, 0.0)
            return f"{NAMES[metric]} beats no shadow by {numbers} beyond the margin {margin:.2g}"
    return ""


def _by_validation(name: str, data: Measured) -> str:
    """A network's failure over all lights of its training."""
    record = data.screen_trainings[name]
    if record["died_at_step"] is not None:
        return f"{name}: died at step {record['died_at_step']:,}"
    lights = record.get("training", {}).get("lights") or range(len(record["validation_mse"]))
    errors = [record["validation_mse"][light] for light in lights]
    nulls = record["null_mse"].items()
    nulls = {null: sum(by_light[light] for light in lights) for null, by_light in nulls}
    least = min(nulls, key=nulls.get)
    if None in errors:
        return f"{name}: its answers are no numbers"
    if sum(errors) < nulls[least]:
        return ""
    ours, theirs = (1e4 * total / len(errors) for total in (sum(errors), nulls[least]))
    return f"{name}: MSE {short(ours)} × 10⁻⁴ on validation frames, {least} {short(theirs)}"
