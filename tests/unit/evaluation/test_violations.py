"""Networks of a known depth, of which it is known how often they break a bound."""

import numpy as np
import pytest
import torch
import trimesh
from evaluated import make_evaluated

from neural_shadows.evaluation import count_violations as stage
from neural_shadows.evaluation.count_violations import count_violations
from neural_shadows.evaluation.metric_files import read_metrics
from neural_shadows.evaluation.ray_network import network_method
from neural_shadows.evaluation.references import References
from neural_shadows.evaluation.violations import (
    RANDOM,
    Violations,
    compare_depths,
    random_depths,
)
from neural_shadows.networks.object_space.shadow_network import ShadowNetwork

BALL = 0.5


def test_counts():
    t_lb = np.float32([0.5, 0.5, 0.5, 0.5, 0.5, 1.2])
    t_ub = np.float32([1.0, 1.0, 1.0, 1.0, 1.0, np.inf])
    #           rounding  short, seen  short  leak  far, lit rightly  short of a miss, unseen
    t = np.float32([0.49995, 0.4, 0.3, 1.5, 1.1, 1.0])
    lit = np.array([False, False, False, True, True, True])
    truth = np.float32([1, 1, 0, 0, 1, 1])
    assert compare_depths(t, t_lb, t_ub, lit, truth) == Violations(6, 3, 2, 1, 2, 1, 1)


def test_random_depths_are_uniform_and_answered_as_depths_are():
    rng = np.random.default_rng(0)
    chord = rng.uniform(0.5, 2, 100_000).astype(np.float32)
    s = rng.uniform(0, 3, len(chord)).astype(np.float32)
    t, lit = random_depths(s, chord, seed=3)
    shares = np.histogram(t / chord, 10, (0, 1))[0] / len(t)
    assert shares == pytest.approx(np.full(10, 0.1), abs=5 * (0.09 / len(t)) ** 0.5)
    # In shadow ⟺ min(s, ℓ) > t, of which a uniform t has the chance min(s, ℓ) / ℓ.
    expected = np.minimum(s, chord) / chord
    assert np.mean(~lit) == pytest.approx(expected.mean(), abs=0.005)
    assert not lit[t < np.minimum(s, chord)].any() and lit[t >= np.minimum(s, chord)].all()
    assert (random_depths(s, chord, seed=4)[0] != t).mean() > 0.99


class Ball(ShadowNetwork):
    """A ball's first hit, moved on by a share of the way to its second; ℓ for rays that miss."""

    def __init__(self, share: float):
        super().__init__()
        self.share = torch.nn.Parameter(torch.tensor(share))

    initialise = None

    def forward(self, origins, directions, dtype):
        b = (origins * directions).sum(1)
        root = (b**2 - (1 - BALL**2)).clamp(min=0).sqrt()
        return torch.where(root > 0, -b - root + 2 * self.share * root, -2 * b + 1e-4)


@pytest.mark.parametrize(
    ("share", "lower", "upper"), [(-0.2, True, False), (0.5, False, False), (1.2, False, True)]
)
def test_a_ball_that_is_short_or_far_breaks_the_bound_on_that_side(
    tmp_path, monkeypatch, share, lower, upper
):
    ball = trimesh.creation.icosphere(5, radius=BALL)
    files = make_evaluated(tmp_path, ball)
    network = Ball(share), torch.float32
    monkeypatch.setattr(stage, "open_network", lambda *_: network)
    path = tmp_path / "violations.csv"
    count_violations(files.references, tmp_path / "w", None, files.mesh_ply, path, method="ball")
    counts = read_metrics([path]).set_index(["part", "frame", "metric"])["value"]
    answer, shown_anywhere = network_method(*network), np.zeros(2)
    for frame, truth in References(files.references):
        view = counts.loc[frame.view.view_set, frame.view.index]
        found, of_random = (
            Violations(**{name: view[start + name] for name in Violations._fields})
            for start in ("", RANDOM)
        )
        visibility = answer(frame)(0.0)
        # The line of a point meets the ball if it passes its centre within the radius.
        light = frame.view.light
        across = np.linalg.norm(frame.p - np.outer(frame.p @ light, light), axis=1)
        hitting = np.count_nonzero(across < BALL)
        assert found.queries > hitting > 100
        assert of_random.queries == found.queries > of_random.lower_violations > 0.1 * hitting
        rim = 0.02 * hitting  # where the facets are within the ball that they stand for
        assert found.lower_violations == pytest.approx(hitting * lower, abs=rim)
        assert found.upper_violations == pytest.approx(hitting * upper, abs=rim)
        # All false shadow and all light leaks come of these violations.
        shares = np.sum(visibility < truth) * lower, np.sum(visibility > truth) * upper
        shown = found.false_shadow_of_lower, found.light_leak_of_upper
        assert shown == pytest.approx(shares, abs=rim)
        shown_anywhere += shown
        # A depth before the ball shows wherever the point is lit, but where it falls short by less
        # than the shading offset.
        assert found.false_shadow_of_lower == pytest.approx(found.lit_of_lower, abs=2 * rim)
    assert (shown_anywhere > 100).tolist() == [lower, upper]


class Dark(Ball):
    """Depths as they are; all points in shadow by a query of its own, as a field's."""

    def points_lit(self, p, light, dtype):
        return lambda depth_bias: torch.zeros(len(p), dtype=torch.bool)


def test_false_shadows_are_those_of_the_network_s_own_query(tmp_path, monkeypatch):
    files = make_evaluated(tmp_path, trimesh.creation.icosphere(3, radius=BALL))
    monkeypatch.setattr(stage, "open_network", lambda *_: (Dark(-0.2), torch.float32))
    path = tmp_path / "violations.csv"
    count_violations(files.references, tmp_path / "w", None, files.mesh_ply, path, method="dark")
    counts = read_metrics([path]).pivot_table("value", ["part", "frame"], "metric")
    assert (counts["false_shadow_of_lower"] == counts["lit_of_lower"]).all()
    assert counts["lit_of_lower"].sum() > 100
