import pandas as pd
import pytest

from neural_shadows.reports.data.chosen_views import choose_views

# FLIP of three methods by view: blank, then an error that grows, and a spread that does not.
FLIP = {
    0: (0.0, 0.0, 0.0),
    1: (0.01, 0.01, 0.011),
    2: (0.02, 0.01, 0.03),
    3: (0.03, 0.01, 0.09),
    4: (0.04, 0.02, 0.05),
    5: (0.05, 0.00, 0.90),
    6: (0.06, 0.06, 0.061),
}


def metrics_of(flip, methods=("a", "b", "c"), view_set="shadow"):
    return pd.DataFrame(
        [
            (view, view_set, method, metric, value)
            for view, values in flip.items()
            for method, value in zip(methods, values, strict=True)
            for metric, value in (("psnr", 99.0), ("flip", value))
        ],
        columns=["view", "view_set", "method", "metric", "value"],
    )


def test_of_the_middling_views_the_one_that_tells_methods_apart():
    assert choose_views(metrics_of(FLIP)) == {"shadow": ("shadow", 3)}


@pytest.mark.parametrize("blank", [1, 5, 20])
def test_a_view_without_differences_is_not_shown(blank):
    flip = dict.fromkeys(range(blank), (0.0, 0.0, 0.0)) | {blank: (0.02, 0.01, 0.03)}
    assert choose_views(metrics_of(flip)) == {"shadow": ("shadow", blank)}
    # Where there is no other it is shown all the same.
    assert choose_views(metrics_of({7: (0.0, 0.0, 0.0)})) == {"shadow": ("shadow", 7)}


def test_neither_order_nor_no_shadow_has_a_say():
    metrics = metrics_of(FLIP)
    null = metrics_of({v: (0.9 - v / 10,) for v in FLIP}, ["no_shadow"])
    both = pd.concat([metrics, null])
    for seed in range(5):
        assert choose_views(both.sample(frac=1, random_state=seed)) == choose_views(metrics)


def test_of_a_half_finished_run_a_view_that_most_methods_have():
    half = metrics_of({view: (view / 100,) for view in (4, 5, 6)}, ["half"])
    assert choose_views(pd.concat([metrics_of(FLIP), half])) == {"shadow": ("shadow", 5)}
    # Two methods without a view in common.
    parts = [metrics_of({view: (0.1,)}, [method]) for view, method in ((0, "a"), (1, "b"))]
    assert choose_views(pd.concat(parts))["shadow"][1] in (0, 1)


def test_one_method_and_each_view_set():
    two = [metrics_of({v: (v / 10,) for v in range(5)}, ["a"], s) for s in ("surface", "shadow")]
    found = choose_views(pd.concat(two))
    assert [found[key][0] for key in ("surface", "shadow")] == ["surface", "shadow"]
    assert found["shadow"][1] in (2, 3)
