"""Which lights pictures show."""

import pytest

from neural_shadows.reports.data.lights import shown_radii


@pytest.mark.parametrize(
    ("radii", "shown"),
    [
        ([0, 0.1, 0.2, 0.4], [1, 2, 3]),
        ([0.1, 0.2, 0.4, 0.8], [0, 2, 3]),  # no point light among them
        ([0, 0.1], [1]),
        ([0], [0]),
        ([0.1], [0]),
    ],
)
def test_the_least_light_but_a_point_the_middle_and_the_largest(radii, shown):
    assert shown_radii(radii) == shown
