"""Lengths and cosines of vectors, beside numpy's."""

import numpy as np

from neural_shadows.rendering.lengths import lengths_and_cosines, lengths_of


def test_they_are_numpy_s():
    rng = np.random.default_rng(3)
    vectors, units = rng.normal(size=(2, 1000, 3)).astype(np.float32)
    units /= np.linalg.norm(units, axis=1, keepdims=True)
    vectors[7] = 0
    lengths, cosines = lengths_and_cosines(vectors, units)
    np.testing.assert_allclose(lengths, np.linalg.norm(vectors, axis=1), rtol=1e-6)
    np.testing.assert_allclose(lengths_of(vectors), lengths, rtol=1e-6)
    assert np.isnan(cosines[7])  # as numpy has it, and no error
    others = np.arange(1000) != 7
    expected = (vectors * units).sum(axis=1)[others] / lengths[others]
    np.testing.assert_allclose(cosines[others], expected, atol=1e-6)
