"""What rules look up: names followed, labels and rows made."""

import json

import pytest
from shipped import shipped

from neural_shadows.config.reading import read_config
from neural_shadows.config.resolved import resolved


@pytest.fixture
def settings(values):
    return resolved(read_config(values))


def row(method, label, published=None, experiment=None, bias=None, scene="dragon"):
    made = {"method": method, "label": label, "published": published, "scene": scene}
    return made | {"experiment": experiment, "bias": bias}


def test_scenes_and_experiments(values):
    values["scenes"]["dragon"] |= {"seed": 0, "mesh": {"path": "../my.dragon.ply.gz"}}
    settings = resolved(read_config(values))
    assert json.loads(json.dumps(settings)) == settings  # plain data, equal in each run
    light = {"domain": "single_axis", "axis": "z", "min_elevation_deg": 20.0}
    scenes, experiments = settings["scenes"], settings["experiments"]
    assert scenes["dragon"]["mesh_name"] == "my.dragon"
    assert scenes["landscape"]["mesh"] == {"generate": "landscape", "cells": 256}
    assert scenes["landscape"]["scene"] == {"up": "y", "ground": False, "light": light}
    frames = {"width": 600, "height": 400, "view_sets": ["centre"], "seed": 2026}
    assert scenes["landscape"]["frames"] == frames
    names = ("fence", "dragon", "ablation_seed_1")
    assert [experiments[name]["seed"] for name in names] == [2026, 0, 1]
    assert experiments["dragon_low_rate"] == {
        "scene": "dragon",
        "sampling": "poisson_quadtree",
        "network": values["networks"]["thesis"] | {"encoding": "frequency"},
        "training": values["trainings"]["low_rate"] | {"loss": {"false_shadow": 1.0}},
        "seed": 0,
        "bias": 0.0,
        "label": "Learning rate 0.0001",
    }
    smoke = resolved(read_config(shipped("smoke")))
    assert smoke["experiments"]["dragon_field"]["label"] == "64³ occupancy field"


def test_rows_of_tables(settings, changed):
    rows = settings["tables"]["table_4_3"]["rows"]
    assert rows[0] == row("shadow_map_2048", "2048² shadow map", "shadow_map_2048")
    assert rows[5:] == [
        row("dragon", "Thesis's network", "network", "dragon", 0.0),
        row("dragon_field", "256³ occupancy field", *["dragon_field"] * 2, "held_out"),
    ]
    rows = settings["tables"]["beyond"]["rows"]
    assert list(dict.fromkeys(r["scene"] for r in rows)) == ["dragon", "fence", "landscape"]
    assert rows[0] == row("ray_traced", "Ray traced")
    own, found = (r for r in rows if r["experiment"] == "dragon")
    assert (own["method"], own["bias"]) == ("dragon", 0.0)
    assert (found["method"], found["bias"]) == ("dragon_biased", "held_out")
    values = changed("tables.maps", {"title": "x", "scene": "fence", "rows": ["shadow_map_64"]})
    maps = resolved(read_config(values))["tables"]["maps"]["rows"]
    assert maps == [row("shadow_map_64", "64² shadow map", scene="fence")]


def test_figures_and_claims(settings):
    figures = settings["figures"]
    curve = {"experiment": "dragon", "label": "Learning rate 0.001"}
    assert figures["figure_4_1"]["curves"][1] == curve
    widths = [(r["method"], r["width"]) for r in figures["figure_4_8"]["rows"]]
    assert widths[:3] == [("dragon_64", 64), ("dragon_128", 128), ("dragon", 256)]
    assert len(widths) == 6  # ray tracing and shadow maps have no width
    methods = [r["method"] for r in figures["figure_beyond_pictures_fence"]["rows"]]
    assert methods[:3] == ["shadow_map_2048", "shadow_map_512", "fence_field_512"]
    assert methods[3:] == ["fence_field", "fence_occupancy_grid", "fence_biased"]
    ((_, shadow_map),) = settings["claims"]["fence_better_than_128"]["pairs"]
    assert shadow_map == row("shadow_map_128", "128² shadow map", scene="fence")
