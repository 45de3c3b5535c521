"""Runs of the workflow that tests share; each is made once and must be left as it is."""

from pathlib import Path
from typing import NamedTuple

import pytest
import trimesh
from checkout import Checkout, write_overlay


class SecondScene(NamedTuple):
    """A finished run whose overlay adds a scene to the smoke configuration."""

    checkout: Checkout
    overlay: Path
    planned: dict[str, str]
    """What Snakemake made for it in a finished checkout: rule by output file."""


@pytest.fixture(scope="session")
def fresh(tmp_path_factory) -> Checkout:
    """A checkout in which nothing has run."""
    return Checkout.fresh(tmp_path_factory.mktemp("fresh"))


@pytest.fixture(scope="session")
def smoke(fresh, tmp_path_factory) -> Checkout:
    """The smoke workflow, run to its end without a disturbance."""
    checkout = fresh.copy(tmp_path_factory.mktemp("smoke"))
    checkout.run()
    return checkout


@pytest.fixture
def finished(smoke, tmp_path) -> Checkout:
    """A copy of the finished smoke run, for a test to change."""
    return smoke.copy(tmp_path / "checkout")


@pytest.fixture(scope="session")
def second_scene(smoke, tmp_path_factory) -> SecondScene:
    """The finished smoke run, and then a scene more: a torus in millimetres, off its origin."""
    folder = tmp_path_factory.mktemp("second_scene")
    checkout = smoke.copy(folder / "checkout")
    torus = trimesh.creation.torus(major_radius=300, minor_radius=90)
    torus.apply_translation([1e4, -2e4, 500]).export(folder / "ring_mm.stl")
    overlay = write_overlay(
        folder / "torus.yaml",
        scenes={"torus": {"mesh": {"path": str(folder / "ring_mm.stl")}, "up": "z"}},
        samplings={
            "few": {
                "sampler": "poisson_quadtree",
                "directions": 20,
                "points_per_direction": 100,
                "silhouette_resolution": 32,
                "shards": 1,
            }
        },
        trainings={"short": {"steps": 20, "batch_size": 256, "learning_rate": 0.001}},
        experiments={
            "torus": {"scene": "torus", "sampling": "few", "network": "thesis", "training": "short"}
        },
        evaluations={
            "torus": {
                "scene": "torus",
                "networks": ["torus"],
                "shadow_maps": [512, 128],
                "view_sets": ["surface"],
            }
        },
        tables={
            "table_torus": {
                "title": "Our method and directional shadow maps on a torus",
                "evaluations": ["torus"],
                "rows": [
                    {"method": "shadow_map_512", "label": "512² map"},
                    {"method": "shadow_map_128", "label": "128² map"},
                    {"method": "torus", "label": "Our method"},
                ],
            }
        },
    )
    planned = checkout.pending(overlays=[overlay])
    checkout.run(overlays=[overlay])
    return SecondScene(checkout, overlay, planned)
