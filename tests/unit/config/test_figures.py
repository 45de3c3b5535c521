"""Figures: of tables, networks and scenes that they can show."""

import pytest

MISTAKES = [
    ("figure_3_1.kind", "view", "`kind` should be one of pictures, loss, widths, pareto, cost"),
    ("figure_3_1.scene", "dog", "figures.figure_3_1.scene: 'dog' is not among dragon, fence"),
    ("figure_3_1.sampling", "x", "figures.figure_3_1.sampling: 'x' is not among poisson_quad"),
    ("figure_4_1.curves", ["x"], "figures.figure_4_1.curves: 'x' is not among dragon"),
    ("figure_4_4.view_sets", ["centre"], "figure_4_4.view_sets: 'centre' is not among shadow, su"),
    ("figure_beyond_dragon.table", "table_4_6", "'table_4_6' is not among beyond, ablations"),
    ("figure_beyond_dragon.scene", "landscap", "(did you mean 'landscape'?) is not among dragon"),
    ("figure_beyond_pictures_fence.scene", None, "figure_beyond_pictures_fence.scene: '' is not"),
    ("figure_beyond_pictures_fence.methods", ["ray_traced"], "methods: 'ray_traced' is not among"),
    ("figure_beyond_slice.experiment", "dragon", "experiment: 'dragon' (did you mean 'dragon_fi"),
]


@pytest.mark.parametrize(("key", "value", "words"), MISTAKES, ids=lambda part: str(part)[:40])
def test_mistakes(message, key, value, words):
    assert words in message(f"figures.{key}", value)
