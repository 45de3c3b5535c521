"""Tables: rows of methods, each once."""

import pytest

ROW = {"method": "shadow_map_512", "bias": "held_out"}
MISTAKES = [
    ("index", {"title": "x", "rows": ["dragon"]}, "tables.index: a report has this name"),
    ("maps", {"title": "x", "rows": ["shadow_map_64"]}, "tables.maps.scene: '' is not among"),
    ("cost.kind", "costs", "`kind` should be one of comparison, frame_times, networks, memory"),
    ("cost.samples", [20000, 20000], "tables.cost.samples = [20000, 20000]: must grow from each"),
    ("table_4_3.published", "5.1", "tables.table_4_3.published = '5.1': String should match"),
    ("table_4_3.figures", ["x"], "tables.table_4_3.figures: 'x' is not among figure_3_1"),
    ("table_4_3.rows.0", "dragn", "tables.table_4_3.rows of dragon: 'dragn' (did you mean 'dragon"),
    ("table_4_3.rows.0", "fence", "rows of dragon: 'fence' is not among shadow_map_N, dragon"),
    ("table_4_3.rows.0", "ray_traced", "rows of dragon: 'ray_traced' is not among"),
    ("table_4_3.rows.0", ROW, "rows with a bias: 'shadow_map_512' is not among dragon"),
    ("table_4_3.rows.0", "shadow_map_512", "'shadow_map_512' is there twice"),
    ("beyond.rows.dragon.13", "dragon", '"Thesis\'s network" is there twice'),
    ("beyond.rows.hill", ["dragon"], "tables.beyond.scene: 'hill' is not among dragon, fence"),
]


@pytest.mark.parametrize(("key", "value", "words"), MISTAKES, ids=lambda part: str(part)[:40])
def test_mistakes(message, key, value, words):
    assert words in message(f"tables.{key}", value)
