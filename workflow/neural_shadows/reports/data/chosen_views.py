"""Choice of a typical viewpoint with different methods' errors."""

import pandas as pd

from neural_shadows.evaluation.null_predictors import is_null

RULE = (
    "Which view is shown: of the middle third of all views by error (the methods' median FLIP), "
    "the one in which the methods differ most (their FLIP's interquartile range)."
)


def choose_views(metrics: pd.DataFrame) -> dict[str, tuple[str, int]]:
    """Choose a view of each view set by `RULE`.

    Views that all methods show as the reference does are left aside where there are others, and
    of a half-finished run those that fewer methods have. Drawing no shadow has no say.

    Args:
        metrics: of a scene's methods, as `read_metrics` gives them.
    """
    errors = metrics[metrics["metric"].eq("flip") & ~metrics["method"].map(is_null)]
    errors = errors.pivot(index=["view_set", "view"], columns="method", values="value")
    chosen = {}
    for view_set, views in errors.groupby("view_set"):
        methods = views.count(axis=1)
        views = views[methods == methods.max()]
        differing = views[views.max(axis=1) > 0]
        views = views if differing.empty else differing
        middle = views.median(axis=1).sort_values(kind="stable").index
        cut = len(middle) // 3
        middling = views.loc[middle[cut : len(middle) - cut]].sort_index()
        spread = middling.quantile(0.75, axis=1) - middling.quantile(0.25, axis=1)
        chosen[view_set] = spread.idxmax()
    return chosen
