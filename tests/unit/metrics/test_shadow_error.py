import numpy as np
import pytest

from neural_shadows.metrics.shadow_error import shadow_error


def test_shadow_error():
    #                      fine fine dark dark leak
    visibility = np.array([1, 0, 0, 0, 1], np.float32)
    reference = np.array([1, 0, 1, 1, 0], np.float32)
    error = shadow_error(visibility, reference)
    assert error == (error.false_shadow, error.light_leak, error.total) == (2 / 5, 1 / 5, 3 / 5)
    # Soft shadows: mean differences.
    error = shadow_error(np.float32([0.25, 0.5, 1]), np.float32([0.75, 0.25, 1]))
    assert error == (0.5 / 3, 0.25 / 3, 0.75 / 3)
    with pytest.raises(ValueError, match="no pixel"):
        shadow_error(np.zeros(0, np.float32), np.zeros(0, np.float32))
