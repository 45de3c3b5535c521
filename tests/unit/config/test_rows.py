"""The rows that tables, figures and claims are made of."""

import pytest

from neural_shadows.config.reading import read_config
from neural_shadows.config.rows import rows_of, rows_of_claim, rows_of_figure


@pytest.fixture
def config(values):
    return read_config(values)


def row(method, label, scene="dragon", published=None, experiment=None, bias=None):
    return {
        "method": method,
        "label": label,
        "published": published,
        "scene": scene,
        "experiment": experiment,
        "bias": bias,
    }


def test_rows_of_a_comparison(config):
    rows = rows_of(config, "table_4_3")
    assert rows[0] == row("shadow_map_2048", "2048² shadow map", published="shadow_map_2048")
    assert rows[5:] == [
        row("dragon", "Thesis's network", published="network", experiment="dragon", bias=0.0),
        row("dragon_field", "256³ occupancy field", published="dragon_field")
        | {"experiment": "dragon_field", "bias": "held_out"},
    ]


def test_rows_by_scene(config, changed):
    rows = rows_of(config, "beyond")
    assert list(dict.fromkeys(r["scene"] for r in rows)) == ["dragon", "fence", "landscape"]
    assert rows[0] == row("ray_traced", "Ray traced")
    own, found = (r for r in rows if r["experiment"] == "dragon")
    assert (own["method"], own["bias"]) == ("dragon", 0.0)
    assert (found["method"], found["bias"]) == ("dragon_biased", "held_out")
    mine = {"title": "x", "rows": ["dragon", {"method": "dragon", "bias": "held_out"}]}
    labels = [r["label"] for r in rows_of(read_config(changed("tables.mine", mine)), "mine")]
    assert labels == ["Thesis's network", "Thesis's network, with bias"]


def test_rows_of_costs(config):
    assert rows_of(config, "cost") == []


def test_maps_alone_name_their_scene(changed):
    table = {"title": "Maps", "scene": "fence", "rows": ["shadow_map_64"]}
    config = read_config(changed("tables.maps", table))
    assert rows_of(config, "maps") == [row("shadow_map_64", "64² shadow map", "fence")]


def test_rows_of_figures(config):
    widths = [(r["method"], r["width"]) for r in rows_of_figure(config, "figure_4_8")]
    assert widths[:3] == [("dragon_64", 64), ("dragon_128", 128), ("dragon", 256)]
    assert len(widths) == 6  # ray tracing and shadow maps have no width
    assert len(rows_of_figure(config, "figure_beyond_fence")) == 12
    pictures = rows_of_figure(config, "figure_beyond_pictures_fence")
    methods = [r["method"] for r in pictures]
    maps = ["shadow_map_2048", "shadow_map_512"]
    assert methods == [*maps, *("fence_field_512", "fence_field"), *methods[4:]]
    assert methods[4:] == ["fence_occupancy_grid", "fence_biased"]


def test_rows_of_claims(config):
    (pair, _) = rows_of_claim(config, "scene_difficulty")
    assert [(r["method"], r["scene"]) for r in pair] == [
        ("landscape_general", "landscape"),
        ("dragon", "dragon"),
    ]
    (pair,) = rows_of_claim(config, "fence_better_than_128")
    assert pair[1] == row("shadow_map_128", "128² shadow map", "fence")
    assert len(rows_of_claim(config, "lower_bound_costs_more")) == 4
