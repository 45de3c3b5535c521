"""Moment shadow maps beside the formulas of Peters and Klein 2015, solved as they are printed."""

import numpy as np

from neural_shadows.shadow_maps.moments import MOMENT_BIAS, hamburger_visibility, powers

COUNT = 50_000


def least_shadow(moments: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Section 4.2: of three depths with these moments, one of them z, the share before z."""
    b = (1 - MOMENT_BIAS) * moments + MOMENT_BIAS / 2
    b = np.concatenate([np.ones((len(b), 1)), b], axis=1)
    hankel = b[:, np.add.outer(np.arange(3), np.arange(3))]
    c = np.linalg.solve(hankel, powers_from_0(z)[..., None])[..., 0]
    root = np.sqrt(np.maximum(c[:, 1] ** 2 - 4 * c[:, 2] * c[:, 0], 0))
    depths = np.stack([z, (-c[:, 1] - root) / (2 * c[:, 2]), (-c[:, 1] + root) / (2 * c[:, 2])], 1)
    vandermonde = np.moveaxis(powers_from_0(depths), -1, 1)
    weights = np.linalg.solve(vandermonde, b[:, :3, None])[..., 0]
    return np.clip(np.sum(weights * (depths < z[:, None]), axis=1), 0, 1)


def powers_from_0(z: np.ndarray) -> np.ndarray:
    return np.stack([np.ones_like(z), z, z * z], axis=-1)


def test_random_distributions(measured):
    """Of 3 to 11 depths: of two the system is singular but for the bias."""
    rng = np.random.default_rng(1)
    depths = rng.random((COUNT, 11))
    weights = rng.random((COUNT, 11)) * (np.arange(11) < rng.integers(3, 12, COUNT)[:, None])
    weights /= weights.sum(1, keepdims=True)
    moments = np.einsum("nd,ndk->nk", weights, powers(depths, 4))
    z = rng.random(COUNT)
    found = hamburger_visibility(moments, z)
    off = found - (1 - least_shadow(moments, z))
    measured(
        f"moments beside Peters and Klein's formulas: mean {off.mean():+.1e}, rms "
        f"{np.sqrt(np.mean(off**2)):.1e}, largest {np.abs(off).max():.1e} of {COUNT}"
    )
    assert np.abs(off).max() < 1e-6
    # What they prove: never more shadow than there is.
    lit = np.sum(weights * (depths >= z[:, None]), axis=1)
    assert (found > lit - 1e-3).all()
