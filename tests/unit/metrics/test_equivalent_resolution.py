import pytest

from neural_shadows.metrics.equivalent_resolution import equivalent_resolution

SIZES = (128, 256, 512, 1024, 2048)


def test_between_maps_and_outside():
    errors = [0.16, 0.08, 0.04, 0.02, 0.01]  # halved at each doubling: error = 20.48 / N
    for error, size in ((0.03, 20.48 / 0.03), (0.16, 128), (0.01, 2048)):
        assert equivalent_resolution(SIZES, errors, error) == pytest.approx(size)
    # The order of the maps is of no matter; of several sizes with an error it is the smallest.
    assert equivalent_resolution(SIZES[::-1], errors[::-1], 0.03) == pytest.approx(20.48 / 0.03)
    assert equivalent_resolution((128, 256, 512), (0.02, 0.01, 0.02), 0.02) == pytest.approx(128)
    assert equivalent_resolution(SIZES, errors, 0.2) is None
    assert equivalent_resolution(SIZES, errors, 0.005) is None
