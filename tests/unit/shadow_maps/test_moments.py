"""Visibility from moments of depth beside distributions whose answer is known."""

import numpy as np
import pytest
from scipy.ndimage import correlate1d

from neural_shadows.shadow_maps.moments import (
    blurred,
    box,
    exponential_visibility,
    gaussian,
    hamburger_blockers,
    hamburger_visibility,
    powers,
    variance_visibility,
    warped,
)

ANSWERS = {
    "variance": (lambda depth: powers(depth, 2), variance_visibility),
    "exponential": (warped, exponential_visibility),
    "four moments": (lambda depth: powers(depth, 4), hamburger_visibility),
}


def mixed(of, depths, weights):
    """Moments of a distribution, (1, moments)."""
    return np.average(of(np.array(depths)), axis=0, weights=weights)[None]


@pytest.mark.parametrize("ends", [0.0, 0.5, 1.0])
def test_four_moments_of_nothing_but_the_ends_of_the_range(ends):
    """Where the bias adds no third depth to them: what is at 0 hides as much as it weighs."""
    moments = mixed(lambda depth: powers(depth, 4), [0, 1], [1 - ends, ends])
    depth = np.array([1e-3, 0.3, 0.999, 1.0])
    found = hamburger_visibility(np.repeat(moments, 4, axis=0), depth)
    assert found == pytest.approx(ends, abs=2e-3)


def test_published_vectors_of_four_moments():
    """Two occluders: exact between them; three: a light leak, which is the method's."""
    two = mixed(lambda depth: powers(depth, 4), [0.3, 0.8], [0.4, 0.6])
    assert 1 - hamburger_visibility(two, np.array([0.55])) == pytest.approx(0.4, abs=1e-3)
    assert 1 - hamburger_visibility(two, np.array([0.95])) == pytest.approx(1, abs=5e-3)
    three = mixed(lambda depth: powers(depth, 4), [0.2, 0.5, 0.85], [0.3, 0.4, 0.3])
    assert 1 - hamburger_visibility(three, np.array([0.899])) == pytest.approx(0.812, abs=2e-3)


@pytest.mark.parametrize(("depths", "receiver"), [([0.3], 0.305), ([0.2, 0.3], 0.31)])
def test_a_receiver_close_behind_is_dark(depths, receiver):
    """With the moments' bias of maps of 16 bits a tenth and 0.38 of the light would leak."""
    moments = mixed(lambda depth: powers(depth, 4), depths, np.ones(len(depths)))
    assert hamburger_visibility(moments, np.array([receiver])) < 0.05


def test_bound_of_variance_is_kept_by_any_distribution():
    """At least as much is lit as the distribution has behind the receiver, for all of them."""
    rng = np.random.default_rng(0)
    depths, weights = rng.uniform(0, 1, (200, 5)), rng.dirichlet(np.ones(5), 200)
    receivers = rng.uniform(0, 1, 200)
    lit = np.where(depths >= receivers[:, None], weights, 0).sum(1)
    for name, slack in (("variance", 1e-5), ("exponential", 1e-5), ("four moments", 5e-3)):
        of, visibility = ANSWERS[name]
        moments = np.einsum("nd,ndm->nm", weights, of(depths))
        found = visibility(moments, receivers)
        assert np.all(found >= lit - slack), name
    # Four moments know more than two: their bound is nearer.
    by_two = variance_visibility(np.einsum("nd,ndm->nm", weights, powers(depths, 2)), receivers)
    assert found.mean() < by_two.mean() - 0.02


def test_filters_keep_the_mean_and_what_is_within():
    """As scipy's, which goes on beyond the rim, has it within."""
    moments = powers(np.random.default_rng(1).uniform(0, 1, (24, 31)), 3)
    for kernel in (box(1), box(5), gaussian(15, 3.0), np.array([0.5, 0.2, 0.3])):
        assert kernel.sum() == pytest.approx(1)
        rim = len(kernel) // 2
        whole = correlate1d(correlate1d(moments, kernel, axis=0), kernel, axis=1)
        found = blurred(moments, kernel)
        assert found.shape == (24 - 2 * rim, 31 - 2 * rim, 3)
        assert np.allclose(found, whole[rim : 24 - rim, rim : 31 - rim], rtol=1e-13, atol=0)


@pytest.mark.parametrize("share", [0.1, 0.5, 0.9])
def test_blockers_before_a_receiver_in_the_distribution(share):
    """Of two depths, the receiver's the farther, the mean before it is the nearer."""
    moments = mixed(lambda depth: powers(depth, 4), [0.3, 0.6], [share, 1 - share])
    assert hamburger_blockers(moments, np.array([0.6]), 1e-3) == pytest.approx(0.3, abs=0.01)


def test_blockers_at_two_depths_have_their_mean():
    moments = mixed(lambda depth: powers(depth, 4), [0.2, 0.4, 0.8], [0.1, 0.3, 0.6])
    assert hamburger_blockers(moments, np.array([0.8]), 1e-3) == pytest.approx(0.35, abs=0.01)


def test_without_blockers_their_depth_is_the_receivers():
    moments = mixed(lambda depth: powers(depth, 4), [0.5, 0.8], [0.5, 0.5])
    assert hamburger_blockers(moments, np.array([0.4]), 1e-3) == pytest.approx(0.4, abs=1e-3)


def test_few_blockers_count_less_the_larger_the_least_share():
    """As many as that share: half of the way to the receiver's depth."""
    moments = mixed(lambda depth: powers(depth, 4), [0.2, 0.8], [0.1, 0.9])
    assert hamburger_blockers(moments, np.array([0.8]), 0.1) == pytest.approx(0.5, abs=0.01)
