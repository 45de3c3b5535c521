"""Claims: methods that can be compared."""

import pytest

MISTAKES = [
    ("sampling.kind", "best", "`kind` should be one of better, larger_error, lower_loss, frame_"),
    ("sampling.section", "IV", "claims.sampling.section = 'IV': String should match pattern"),
    ("sampling.pairs", [["dragon"]], "claims.sampling.pairs.0 = ['dragon']: List should have"),
    ("sampling.pairs", [["dragon", "x"]], "claims.sampling.pairs: 'x' is not among dragon"),
    ("sampling.pairs", [["shadow_map_8", "shadow_map_4"]], "one of them should be an experiment"),
    ("learning_rate.pairs", [["dragon", "dragon_biased"]], "'dragon_biased' (did you mean"),
    ("learning_rate.pairs", [["dragon", "dragon"]], "'dragon' is compared with itself"),
    ("lower_bound_costs_more.methods", ["shadow_map_8"], "methods: ['shadow_map_8']: one of"),
    ("lower_bound_costs_more.less", "false_shadow", "more = 'false_shadow': must be another"),
    ("slower_than_shadow_maps.at_least", None, "needs `at_least`, `at_most`, or both"),
    ("slower_than_shadow_maps.table", "table_4_3", "'table_4_3' (did you mean 'table_4_6'?)"),
    ("slower_than_shadow_maps.pairs", [["dragon", "shadow_map_8"]], "'shadow_map_8' (did you me"),
    ("slower_than_shadow_maps.pairs", [["dragon", "landscape_axis"]], "'landscape_axis' is not"),
]


@pytest.mark.parametrize(("key", "value", "words"), MISTAKES, ids=lambda part: str(part)[:40])
def test_mistakes(message, key, value, words):
    assert words in message(f"claims.{key}", value)
