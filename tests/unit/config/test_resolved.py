"""What rules look up: names followed, labels and rows made."""

import json

import pytest
from shipped import shipped

from neural_shadows.config.reading import read_config
from neural_shadows.config.resolved import resolved


@pytest.fixture
def settings(values):
    return resolved(read_config(values))


def row(method, label, published=None, experiment=None, bias=None, scene="dragon", **more):
    made = {"method": method, "label": label, "published": published, "scene": scene}
    trained = experiment is not None
    network = {"experiment": experiment, "encoding": "frequency" if trained else None}
    return made | network | {"trained": trained, "bias": bias} | more


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
    frames["least_shadow"] = 0.08
    assert scenes["landscape"]["frames"] == frames
    names = ("fence", "dragon", "ablation_seed_1")
    assert [experiments[name]["seed"] for name in names] == [2026, 0, 1]
    assert experiments["dragon_low_rate"] == {
        "scene": "dragon",
        "sampling": "poisson_quadtree",
        "network": values["networks"]["thesis"] | {"encoding": "frequency"},
        "training": values["trainings"]["low_rate"]
        | {"optimiser": "adam", "loss": {"false_shadow": 1.0}},
        "seed": 0,
        "bias": 0.0,
        "label": "Learning rate 0.0001",
    }
    smoke = resolved(read_config(shipped("smoke")))
    assert smoke["experiments"]["dragon_field"]["label"] == "64³ occupancy field"


def test_an_arrangement_has_its_own_seed_or_the_run_s(settings):
    scenes = {name: scene["arrangement"] for name, scene in settings["scenes"].items()}
    assert scenes["room"] == {"generate": "room", "seed": 2026, "inserted": {}, "penumbra": None}
    found = scenes["interior_2"]
    assert (found["generate"], found["seed"]) == ("interior", 2)
    assert found["inserted"] == {"dragon": settings["scenes"]["dragon"]["up"]}
    # A mesh stands alone.
    alone = {"generate": "stage", "seed": 2026, "inserted": {"fence": "y"}, "penumbra": None}
    assert scenes["fence"] == alone


def test_a_height_map_has_its_scene_s_up(values):
    values["scenes"]["landscape"]["up"] = "x"
    network = resolved(read_config(values))["experiments"]["landscape_heights"]["network"]
    assert network == {"encoding": "height_map", "up": "x", "resolution": 257, "bits": 16}


@pytest.mark.parametrize("scale", ["lab", "thesis"])
def test_what_a_scale_compares_with_the_thesis_s_network_has_its_samples_and_rays(scale):
    """Anchors of config.yaml are followed before an overlay changes what they name."""
    settings = resolved(read_config(shipped(scale)))
    tables = settings["tables"].values()
    rows = [row for table in tables if table["kind"] == "networks" for row in table["rows"]]
    names = {row["experiment"] for row in rows} - {None}
    compared = [settings["experiments"][name] for name in names]
    compared = [one for one in compared if one["network"]["encoding"] == "frequency"]
    sizes = set()
    for one in compared:
        rays = settings["samplings"][one["sampling"]]
        sizes.add(
            (
                one["training"]["steps"] * one["training"]["batch_size"],
                rays["directions"] * rays["points_per_direction"],
            )
        )
    expected = {"lab": (50_000 * 65_536, 5000 * 10_000), "thesis": (10**6 * 65_536, 250_000_000)}
    assert len(compared) > 10 and sizes == {expected[scale]}
    smallest = [settings["samplings"][f"min_quad_{size}"]["min_quad"] for size in (2, 4, 8)]
    assert smallest == [2, 4, 8]
    # A list is replaced as a whole: the copy has all rows of the desk's but the one of other batches.
    kept, desk = (
        [row["method"] for row in one["tables"]["beyond"]["rows"] if row["scene"] == "dragon"]
        for one in (settings, resolved(read_config(shipped())))
    )
    desk.remove("dragon_muon_4096_biased")
    assert kept == desk


def test_claims_on_unseen_scenes_name_them():
    settings = resolved(read_config(shipped()))
    claim = settings["claims"]["shipped_rays_better_than_filters_of_its_time"]
    assert (
        claim["scenes"] == settings["frame_sets"]["windows"]["unseen"]
        and len(claim["scenes"]) == 13
    )
    assert settings["claims"]["pcss_better_than_moments"]["scenes"] is None


def test_rows_of_tables(settings, changed):
    rows = settings["tables"]["table_4_3"]["rows"]
    assert rows[0] == row("shadow_map_2048", "2048² shadow map", "shadow_map_2048")
    assert rows[5:] == [
        row("dragon", "Thesis's network", "network", "dragon", 0.0),
        row(
            "dragon_field",
            "256³ occupancy field",
            *["dragon_field"] * 2,
            "held_out",
            encoding="occupancy_field",
        ),
        row("no_shadow", "No shadow", "no_shadow"),
        row("all_dark", "All dark", "all_dark"),
    ]
    rows = settings["tables"]["beyond"]["rows"]
    assert list(dict.fromkeys(r["scene"] for r in rows)) == ["dragon", "fence", "landscape"]
    assert rows[0] == row("ray_traced", "Ray traced")
    own, found = (r for r in rows if r["experiment"] == "dragon")
    assert (own["method"], own["bias"]) == ("dragon", 0.0)
    assert (found["method"], found["bias"]) == ("dragon_biased", "held_out")
    given = ["all_dark", {"method": "shadow_map_pcf_64", "bias": "held_out"}]
    values = changed("tables.maps", {"title": "x", "scene": "fence", "rows": given})
    assert resolved(read_config(values))["tables"]["maps"]["rows"] == [
        row("all_dark", "All dark", scene="fence"),  # where it is asked for
        row(
            "shadow_map_pcf_64_biased",
            "64² shadow map, 2 × 2 PCF, with bias",
            scene="fence",
            bias="held_out",
        ),
        row("no_shadow", "No shadow", scene="fence"),
    ]
    # Each scene has its own; what has no quality has none.
    null = [(r["scene"], r["method"]) for r in settings["tables"]["beyond"]["rows"]][-2:]
    assert null == [("landscape", "no_shadow"), ("landscape", "all_dark")]
    assert "no_shadow" in [r["method"] for r in settings["tables"]["table_4_6"]["rows"]]
    assert "no_shadow" not in [r["method"] for r in settings["tables"]["table_4_7"]["rows"]]


def test_figures_and_claims(settings):
    figures = settings["figures"]
    curve = {"experiment": "dragon", "label": "Learning rate 0.001"}
    assert figures["figure_4_1"]["curves"][1] == curve
    widths = [(r["method"], r["width"]) for r in figures["figure_4_8"]["rows"]]
    assert widths[:3] == [("dragon_64", 64), ("dragon_128", 128), ("dragon", 256)]
    assert len(widths) == 6  # ray tracing and shadow maps have no width
    methods = [r["method"] for r in figures["figure_beyond_pictures_fence"]["rows"]]
    assert methods[:3] == ["shadow_map_2048", "shadow_map_512", "fence_mesh_20k"]
    assert methods[3:] == ["fence_distances_256", "fence_field_512", "fence_biased"]
    ((_, shadow_map),) = settings["claims"]["fence_better_than_128"]["rows"]
    assert shadow_map == row("shadow_map_128", "128² shadow map", scene="fence")


def test_claims_on_methods_without_a_network_and_on_what_is_printed(changed):
    pairs = [["dragon_biased", "shadow_map_64_biased"], ["no_shadow", "fence"]]
    claims = resolved(read_config(changed("claims.sampling.pairs", pairs)))["claims"]
    methods = [
        (r["scene"], r["method"], r["bias"]) for pair in claims["sampling"]["rows"] for r in pair
    ]
    assert methods == [
        ("dragon", "dragon_biased", "held_out"),
        ("dragon", "shadow_map_64_biased", "held_out"),
        ("fence", "no_shadow", None),
        ("fence", "fence", 0.0),
    ]
    needs = {"device": None, "seeds": 3, "budget": 1.0, "mesh": "thesis", "trunk": None}
    assert claims["dragon_better_than_256"]["needs"] == needs
    assert claims["dragon_better_than_256"]["metrics"] == ["lpips"]
    (pair,) = claims["printed_fence_better_than_128"]["pairs"]
    assert pair == ["network", "shadow_map_128"]


def test_learning_curves(settings, changed):
    assert settings["learning_curves"] == {}
    given = {"experiments": ["dragon", "dragon_64"], "steps": [10, 100, 12000], "seeds": 2}
    values = changed("learning_curves", {"on_rays": given})
    values["scenes"]["dragon"]["seed"] = 5
    found = resolved(read_config(values))
    names = ["dragon_10_steps_seed_5", "dragon_10_steps_seed_6", "dragon_100_steps_seed_5"]
    names += ["dragon_100_steps_seed_6", "dragon", "dragon_12000_steps_seed_6"]
    points = found["learning_curves"]["dragon"]
    assert [point["experiment"] for point in points] == names
    assert points[2] == {"experiment": names[2], "steps": 100, "seed": 5, "samples": 51200}
    dragon, point = found["experiments"]["dragon"], found["experiments"][names[3]]
    assert point == dragon | {"seed": 6, "training": dragon["training"] | {"steps": 100}}
    assert point["training"]["schedule"] == "cosine"  # of its own length
    assert len(found["experiments"]) == len(settings["experiments"]) + 10


def test_learning_curves_over_frames(changed):
    given = {"experiments": ["kpnsm"], "frames": [16, 32, 64], "steps": [10, 600], "seeds": 2}
    found = resolved(read_config(changed("learning_curves", {"windows": given})))
    points = found["learning_curves"]["kpnsm"]
    assert len(points) == 12 and points[10]["experiment"] == "kpnsm"  # of 64 frames and 600 steps
    name = "kpnsm_16_frames_10_steps_seed_2027"
    point = {"experiment": name, "steps": 10, "seed": 2027, "frames": 16, "samples": 80}
    assert points[1] == point
    kpnsm, section = found["experiments"]["kpnsm"], found["experiments"][name]
    training = kpnsm["training"] | {"steps": 10}
    assert section == kpnsm | {"seed": 2027, "frames": 16, "training": training}


def test_a_network_that_is_built_and_not_trained(changed, message):
    built = {"scene": "dragon", "network": {"encoding": "mesh", "bits": 9}, "label": "{bits} bits"}
    field = {"encoding": "occupancy_field", "start": "distances", "resolution": 32}
    values = changed("experiments.built", built)
    values["experiments"]["distances"] = built | {"network": field, "label": "Distances"}
    fitted = field | {"start": "fitted", "stored": "coded"}
    values["experiments"]["fitted"] = built | {"network": fitted, "label": "Fitted"}
    experiments = resolved(read_config(values))["experiments"]
    for name, label in (("built", "9 bits"), ("distances", "Distances"), ("fitted", "Fitted")):
        section = experiments[name]
        assert section["sampling"] is section["training"] is None and section["label"] == label
    curves = {"experiments": ["built"], "steps": [1, 2, 3], "seeds": 1}
    pair = {"kind": "better", "metrics": ["loss"], "statement": "x", "pairs": [["built", "dragon"]]}
    for wrong, words in (
        (
            {"learning_curves": {"c": curves}},
            "learning_curves.c.experiments: 'built' has no training",
        ),
        ({"claims": {"loss": pair}}, "claims.loss.pairs: 'built' is not trained and has no loss"),
    ):
        assert words in message(values | wrong)
