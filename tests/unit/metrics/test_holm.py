import numpy as np
import pytest

from neural_shadows.metrics.holm import holm


def test_adjusted_as_by_hand():
    # Times 4, 3, 2 and 1 by rank, none below the one before (Holm 1979).
    np.testing.assert_allclose(holm([0.01, 0.04, 0.03, 0.005]), [0.03, 0.06, 0.06, 0.02])
    assert holm([0.7, 0.9]).tolist() == [1, 1]


def test_false_rejections_together_are_as_rare_as_asked():
    rng = np.random.default_rng(2)
    plain, adjusted = 0, 0
    for _ in range(2000):
        p = rng.uniform(size=8)
        plain += p.min() < 0.05
        adjusted += holm(p).min() < 0.05
    assert plain / 2000 == pytest.approx(1 - 0.95**8, abs=0.04)
    assert adjusted / 2000 == pytest.approx(0.05, abs=0.02)
