"""What rules look up: names followed, labels and rows made."""

import json

import pytest
from shipped import shipped

from neural_shadows.config.reading import read_config
from neural_shadows.config.resolved import resolved


@pytest.fixture
def settings(values):
    return resolved(read_config(values))


def row(method, label, scene="dragon", published=None, experiment=None, bias=None):
    return {
        "method": method,
        "label": label,
        "published": published,
        "scene": scene,
        "experiment": experiment,
        "bias": bias,
    }


def test_scenes_and_experiments(values, settings):
    assert json.loads(json.dumps(settings)) == settings  # plain data, equal in each run
    light = {"domain": "single_axis", "axis": "z", "min_elevation_deg": 20.0}
    assert settings["scenes"]["landscape"] == {
        "mesh": {"generate": "landscape", "cells": 256},
        "mesh_name": "landscape",
        "seed": 2026,
        "view_sets": ["centre"],
        "scene": {"up": "y", "ground": False, "light": light},
        "frames": {"width": 600, "height": 400, "view_sets": ["centre"], "seed": 2026},
        **{"up": "y", "ground": False, "light": light},
    }
    assert settings["experiments"]["dragon_low_rate"] == {
        "scene": "dragon",
        "sampling": "poisson_quadtree",
        "network": values["networks"]["thesis"] | {"encoding": "frequency"},
        "training": values["trainings"]["low_rate"] | {"loss": {"false_shadow": 1.0}},
        "seed": 2026,
        "bias": 0.0,
        "label": "Learning rate 0.0001",
    }


def test_what_follows_from_other_settings(values):
    values["scenes"]["dragon"] |= {"seed": 0, "mesh": {"path": "../my.dragon.ply.gz"}}
    values["scenes"]["plain"] = {"mesh": {"generate": "fence"}, "ground": False}
    values["experiments"]["fence"].pop("label")
    made = resolved(read_config(values))
    experiments, scenes = made["experiments"], made["scenes"]
    names = ("fence", "dragon", "ablation_seed_1")
    assert [experiments[name]["seed"] for name in names] == [2026, 0, 1]
    assert experiments["ablation_half"]["training"]["steps"] == 1000  # a section of its own
    assert experiments["fence"]["label"] == "fence"
    assert scenes["dragon"]["mesh_name"] == "my.dragon"
    assert scenes["dragon"]["view_sets"] == ["shadow", "surface"]
    assert scenes["plain"]["view_sets"] == ["centre"]
    smoke = resolved(read_config(shipped("smoke", dragon="stanford")))
    assert smoke["experiments"]["dragon_field"]["label"] == "64³ occupancy field"
    assert smoke["scenes"]["dragon"]["mesh_name"] == "stanford_dragon"


def test_rows_of_tables(settings, changed):
    rows = settings["tables"]["table_4_3"]["rows"]
    assert rows[0] == row("shadow_map_2048", "2048² shadow map", published="shadow_map_2048")
    assert rows[5:] == [
        row("dragon", "Thesis's network", "dragon", "network", "dragon", 0.0),
        row("dragon_field", "256³ occupancy field", "dragon", *["dragon_field"] * 2, "held_out"),
    ]
    assert settings["tables"]["table_4_1"]["rows"][1]["label"] == "Uniform quadtree sampling"
    assert settings["tables"]["cost"]["rows"] == []
    rows = settings["tables"]["beyond"]["rows"]
    assert list(dict.fromkeys(r["scene"] for r in rows)) == ["dragon", "fence", "landscape"]
    assert rows[0] == row("ray_traced", "Ray traced")
    own, found = (r for r in rows if r["experiment"] == "dragon")
    assert (own["method"], own["bias"]) == ("dragon", 0.0)
    assert (found["method"], found["bias"]) == ("dragon_biased", "held_out")
    changed(
        "tables.mine", {"title": "x", "rows": ["dragon", {"method": "dragon", "bias": "held_out"}]}
    )
    values = changed("tables.maps", {"title": "x", "scene": "fence", "rows": ["shadow_map_64"]})
    tables = resolved(read_config(values))["tables"]
    labels = [r["label"] for r in tables["mine"]["rows"]]
    assert labels == ["Thesis's network", "Thesis's network, with bias"]
    assert tables["maps"]["rows"] == [row("shadow_map_64", "64² shadow map", "fence")]


def test_figures(settings):
    figures = settings["figures"]
    curve = {"experiment": "dragon", "label": "Learning rate 0.001"}
    assert figures["figure_4_1"]["curves"][1] == curve
    assert figures["figure_4_4"]["scene"] == "dragon"
    widths = [(r["method"], r["width"]) for r in figures["figure_4_8"]["rows"]]
    assert widths[:3] == [("dragon_64", 64), ("dragon_128", 128), ("dragon", 256)]
    assert len(widths) == 6  # ray tracing and shadow maps have no width
    assert len(figures["figure_beyond_fence"]["rows"]) == 12
    methods = [r["method"] for r in figures["figure_beyond_pictures_fence"]["rows"]]
    assert methods[:3] == ["shadow_map_2048", "shadow_map_512", "fence_field_512"]
    assert methods[3:] == ["fence_field", "fence_occupancy_grid", "fence_biased"]


def test_claims(settings):
    claims = settings["claims"]
    (pair, _) = claims["scene_difficulty"]["pairs"]
    assert [(r["method"], r["scene"]) for r in pair] == [
        ("landscape_general", "landscape"),
        ("dragon", "dragon"),
    ]
    ((_, shadow_map),) = claims["fence_better_than_128"]["pairs"]
    assert shadow_map == row("shadow_map_128", "128² shadow map", "fence")
    methods = claims["lower_bound_costs_more"]["methods"]
    assert len(methods) == 4 and methods[0]["experiment"] == "dragon"
