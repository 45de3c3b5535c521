"""What rules look up."""

import json

from neural_shadows.config.reading import read_config
from neural_shadows.config.resolved import resolved


def test_resolved(values):
    config = read_config(values)
    settings = resolved(config)
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
        "network": config.networks["thesis"].model_dump(),
        "training": config.trainings["low_rate"].model_dump(),
        "seed": 2026,
        "bias": 0.0,
        "label": "Learning rate 0.0001",
    }
    assert settings["tables"]["table_4_1"]["rows"][1]["label"] == "Uniform quadtree sampling"
    assert settings["figures"]["figure_4_1"]["curves"][1] == {
        "experiment": "dragon",
        "label": "Learning rate 0.001",
    }
    assert settings["figures"]["figure_4_4"]["scene"] == "dragon"
    assert len(settings["figures"]["figure_4_4"]["rows"]) == 7
    ((winner, loser),) = settings["claims"]["dragon_better_than_256"]["pairs"]
    assert (winner["method"], loser["method"]) == ("dragon", "shadow_map_256")
    (network, *_) = settings["claims"]["lower_bound_costs_more"]["methods"]
    assert network["experiment"] == "dragon"
