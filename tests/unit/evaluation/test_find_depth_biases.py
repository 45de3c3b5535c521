"""The bias that is found is the one with which a known network errs least."""

import json

import pytest
import torch
import trimesh

from neural_shadows.errors import InputError
from neural_shadows.evaluation import find_depth_biases as depth_bias
from neural_shadows.evaluation.depth_biases import biases_by_method, read_depth_biases
from neural_shadows.evaluation.find_depth_biases import BIASES, find_depth_biases
from neural_shadows.networks.object_space.shadow_network import ShadowNetwork

BALL = 0.5


class ShortBall(ShadowNetwork):
    """The exact first hit of a ball, less a constant; ℓ for rays that miss it."""

    def __init__(self, short: float):
        super().__init__()
        self.short = torch.nn.Parameter(torch.tensor(short))

    def initialise(self, seed):
        raise NotImplementedError

    def forward(self, origins, directions, dtype):
        b = (origins * directions).sum(1)
        discriminant = b**2 - (1 - BALL**2)
        hit = -b - discriminant.clamp(min=0).sqrt()
        return torch.where(discriminant > 0, hit - self.short, -2 * b + 1e-4)


@pytest.fixture
def find(tmp_path, monkeypatch):
    trimesh.creation.icosphere(5, radius=BALL).export(tmp_path / "mesh.ply")
    networks = {"a": ShortBall(0.0), "b": ShortBall(0.05)}
    monkeypatch.setattr(depth_bias, "load_network", lambda name: (networks[name], {}))

    def find(**settings):
        find_depth_biases(
            tmp_path / "mesh.ply",
            {name: name for name in networks},
            tmp_path / "found.json",
            **{
                "view_sets": ["surface"],
                "first": 3,
                "last": 5,
                "frames": {
                    "up": "y",
                    "ground": True,
                    "light": {"domain": "sphere", "min_elevation_deg": 30},
                    "width": 150,
                    "height": 100,
                    "seed": 1,
                },
                "reference": "exact",
            }
            | settings,
        )
        return json.loads((tmp_path / "found.json").read_text())

    return find


def test_a_short_depth_gets_the_bias_that_it_lacks(find, tmp_path):
    found = find()
    assert read_depth_biases(tmp_path / "found.json") == {
        name: found[name]["depth_bias"] for name in ("a", "b")
    }
    assert list(biases_by_method([tmp_path / "found.json"])) == ["a_biased", "b_biased"]
    # A ball of 20,480 triangles is up to 3e-4 within the exact one; behind it nothing is near.
    assert 0.04 <= found["b"]["depth_bias"] <= 0.13
    assert found["a"]["depth_bias"] < found["b"]["depth_bias"]
    for name in ("a", "b"):
        errors = found[name]["errors"]
        assert [error["depth_bias"] for error in errors] == list(BIASES)
        total = [error["false_shadow"] + error["light_leak"] for error in errors]
        assert total[BIASES.index(found[name]["depth_bias"])] == min(total)
        # More bias, less false shadow and more leak.
        false_shadow = [error["false_shadow"] for error in errors]
        assert false_shadow == sorted(false_shadow, reverse=True)
        assert found[name]["views"] == 2
    assert found["b"]["errors"][0]["false_shadow"] > 0.05


def test_other_views_are_other_errors(find):
    first = find()["b"]["errors"]
    assert find(first=5, last=7)["b"]["errors"] != first
    assert find()["b"]["errors"] == first


@pytest.mark.parametrize("text", ["[]", '{"a": 1}', '{"a": {"depth_bias": "x"}}'])
def test_a_file_of_something_else_is_moved_aside(tmp_path, text):
    path = tmp_path / "found.json"
    path.write_text(text)
    with pytest.raises(InputError, match="no file of depth biases"):
        read_depth_biases(path)
    assert not path.exists()
