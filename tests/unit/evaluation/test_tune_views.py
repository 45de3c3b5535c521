import numpy as np
import pytest
import torch
import trimesh
from evaluated import SCENE, make_evaluated

from neural_shadows.evaluation import ray_network, views
from neural_shadows.evaluation import tune as tune_stage
from neural_shadows.evaluation.method import BIASES
from neural_shadows.evaluation.tune import tune
from neural_shadows.files.whole_files import read_json
from neural_shadows.networks.object_space.shadow_network import ShadowNetwork
from neural_shadows.representations.depths import LIT

BALL = 0.5


class ShortBall(ShadowNetwork):
    """The exact first hit of a ball, less a constant; lit are rays that miss it."""

    def __init__(self, short: float):
        super().__init__()
        self.short = torch.nn.Parameter(torch.tensor(short))

    initialise = None

    def forward(self, origins, directions, dtype):
        b = (origins * directions).sum(1)
        discriminant = b**2 - (1 - BALL**2)
        hit = -b - discriminant.clamp(min=0).sqrt()
        return torch.where(discriminant > 0, hit - self.short, LIT)


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    frames = {"width": 150, "height": 100, "view_sets": ["surface"], "seed": 1}
    ball = trimesh.creation.icosphere(5, radius=BALL)
    return make_evaluated(tmp_path_factory.mktemp("ball"), ball, first=3, frames=frames)


@pytest.fixture
def find(files, tmp_path, monkeypatch):
    """What is found for a network, or for a key."""
    torch.set_num_threads(1)

    def found(method):
        is_map = isinstance(method, str)
        monkeypatch.setattr(ray_network, "open_network", lambda *_: (method, torch.float32))
        inputs = [files.mesh_ply] * is_map, [tmp_path / "weights"] * (not is_map)
        out = tmp_path / "found.json"
        name = method if is_map else "net"
        tune([files.references], *inputs, out, method=name, scene=SCENE)
        (chosen,) = read_json(out)["radii"]
        return chosen["constants"] | {"errors": chosen["tried"], "at_end": bool(chosen["at_end"])}

    return found


def test_a_depth_gets_the_bias_that_it_lacks(find):
    found = {short: find(ShortBall(short)) for short in (0.0, 0.05, -0.7)}
    # A ball of 20,480 triangles is up to 3e-4 within the exact one; behind it nothing is near.
    assert 0.04 <= found[0.05]["depth_bias"] <= 0.13
    assert found[0.0]["depth_bias"] < found[0.05]["depth_bias"]
    # So far inside the ball that the ground below it is lit: even the least is not little enough.
    assert (found[-0.7]["depth_bias"], found[-0.7]["at_end"]) == (BIASES[0], True)
    errors = found[0.05]["errors"]
    assert [error["depth_bias"] for error in errors] == list(BIASES) == sorted(set(BIASES))
    assert errors[BIASES.index(0.0)]["false_shadow"] > 0.05
    assert (BIASES[0], BIASES[-1], len(BIASES)) == (-0.016, 0.128, 1 + 25 + 16)


def test_an_end_of_the_search_is_told(find, capsys):
    assert not find(ShortBall(0.05))["at_end"]
    assert "warning" not in capsys.readouterr().out
    # Too short by what the largest alone mends.
    found = find(ShortBall(0.12))
    assert (found["depth_bias"], found["at_end"]) == (BIASES[-1], True)
    assert "the best depth bias, 0.128, ends the search" in capsys.readouterr().out


@pytest.mark.parametrize(("before", "counts"), [(1.02, True), (1.005, False)])
def test_an_end_counts_where_errors_still_fall(before, counts):
    settings = [{"sigma": value} for value in (16.0, 32.0, 64.0)]
    told = tune_stage._at_end("sigma", (16.0, 32.0, 64.0), settings, [1.5, before, 1.0], 2)
    assert told == counts


def test_a_push_is_found_beside_the_bias(find, capsys):
    class Pushed(ShortBall):
        pushes = (0.0, 0.5, 1.0)

        def forward(self, *rays):
            return super().forward(*rays) + 0.4 * self.push

    # 0.2 too short: half a push mends it, and no bias does.
    found = find(Pushed(0.2))
    assert found["push"] == 0.5 and abs(found["depth_bias"]) < 0.02 and not found["at_end"]
    assert len(found["errors"]) == 3 * len(BIASES)
    # Where the largest is best, a larger one might be better.
    found = find(Pushed(0.4))
    assert found["push"] == 1.0 and found["depth_bias"] < 0.02 and found["at_end"]
    assert "the best push, 1.0, ends the search" in capsys.readouterr().out


def test_a_map_that_needs_no_bias_gets_none(find):
    found = find("shadow_map_2048")
    errors = {error["depth_bias"]: error for error in found["errors"]}
    assert errors[-0.016]["false_shadow"] > 0.1 > 0.01 > errors[0.0]["false_shadow"]
    assert abs(found["depth_bias"]) < 0.003 and "push" not in found


def test_of_equal_errors_a_map_takes_the_smallest_bias(find, monkeypatch):
    """The first is the most negative."""
    errors = np.where(np.abs(BIASES) < 0.004, 0.1, 0.2)[:, None]
    monkeypatch.setattr(views.View, "errors_of", lambda *_: ([errors], 1))
    assert find("shadow_map_128")["depth_bias"] == 0.0
