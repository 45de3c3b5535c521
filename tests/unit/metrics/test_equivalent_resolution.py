import pytest
from report_samples import PUBLISHED

from neural_shadows.metrics.equivalent_resolution import equivalent_resolution
from neural_shadows.metrics.registry import error_of
from neural_shadows.reports.data.published import read_published

SIZES = (128, 256, 512, 1024, 2048)


@pytest.mark.parametrize(("metric", "size"), [("lpips", 386), ("psnr", 191)])
def test_what_the_thesis_network_is_worth_on_the_dragon(metric, size):
    printed = read_published(PUBLISHED).loc["4.3"]
    maps = [error_of(metric, printed[f"shadow_map_{n}", metric]) for n in SIZES]
    ours = error_of(metric, printed["network", metric])
    assert round(equivalent_resolution(SIZES, maps, ours)) == size


def test_between_maps_and_outside():
    errors = [0.16, 0.08, 0.04, 0.02, 0.01]  # halved at each doubling: error = 20.48 / N
    for error, size in ((0.03, 20.48 / 0.03), (0.16, 128), (0.01, 2048)):
        assert equivalent_resolution(SIZES, errors, error) == pytest.approx(size)
    # The order of the maps is of no matter; of several sizes with an error it is the smallest.
    assert equivalent_resolution(SIZES[::-1], errors[::-1], 0.03) == pytest.approx(20.48 / 0.03)
    assert equivalent_resolution((128, 256, 512), (0.02, 0.01, 0.02), 0.02) == pytest.approx(128)
    assert equivalent_resolution(SIZES, errors, 0.2) is None
    assert equivalent_resolution(SIZES, errors, 0.005) is None
