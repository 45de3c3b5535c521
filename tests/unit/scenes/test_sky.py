"""Sun and sky by known days and angles."""

import numpy as np
import pytest

from neural_shadows import InputError, sky_patches, sun_directions

UPS = {"x": [1, 0, 0], "y": [0, 1, 0], "z": [0, 0, 1]}
NORTHS = {"x": [0, 0, 1], "y": [0, 0, -1], "z": [0, 1, 0]}


@pytest.mark.parametrize("up", UPS)
def test_patches_cover_the_sky(up):
    directions, angles = sky_patches(up)
    assert directions.shape == (145, 3)
    np.testing.assert_allclose(np.linalg.norm(directions, axis=1), 1)
    heights = directions @ UPS[up]
    assert angles.sum() == pytest.approx(2 * np.pi)
    # Light of a uniform sky on level ground is π; of its middles in bands of 12° to 0.6 %.
    assert (angles * heights).sum() == pytest.approx(np.pi, rel=6e-3)
    assert np.degrees(np.arcsin(heights.min())) == pytest.approx(6)
    assert heights.max() == pytest.approx(1)
    # As much from each side.
    np.testing.assert_allclose((angles[:, None] * directions).sum(0), np.dot(angles, heights) * np.array(UPS[up]), atol=1e-9)  # fmt: skip
    assert directions[0] @ NORTHS[up] == pytest.approx(np.cos(np.radians(6)))


@pytest.mark.parametrize("up", UPS)
def test_the_sun_of_an_equinox_and_of_solstices(up):
    """Cooper's declination is 0 on day 81 and 23.45° on day 172."""
    for latitude in (-35, 0, 48.1, 66):
        sun = sun_directions(latitude, 81, 10, up)
        assert len(sun) == 72  # twelve hours
        noon = np.degrees(np.arcsin((sun @ UPS[up]).max()))
        assert noon == pytest.approx(90 - abs(latitude), abs=1.3)  # five minutes off noon
    heights = {
        day: np.arcsin((sun_directions(48.1, day, 10, up) @ UPS[up]).max()) for day in (172, 355)
    }
    assert np.degrees(heights[172]) == pytest.approx(90 - 48.1 + 23.45, abs=0.15)
    assert np.degrees(heights[355]) == pytest.approx(90 - 48.1 - 23.45, abs=0.15)
    sun = sun_directions(48.1, 81, 10, up)
    east = np.cross(NORTHS[up], UPS[up])
    assert sun[0] @ east > 0.9 and sun[-1] @ east < -0.9  # it rises in the east
    assert sun[36] @ NORTHS[up] < 0 and sun_directions(-35, 81, 10, up)[36] @ NORTHS[up] > 0


def test_the_poles():
    assert len(sun_directions(80, 172)) == 144 and len(sun_directions(80, 355)) == 0


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((91, 80), "latitude: 91: out of range"),
        ((48, 0), "day: 0: out of range"),
        ((48, 80, 7), "minutes: 7: out of range. Give a divisor of 1440"),
        ((48, 80, 0), "minutes: 0"),
        ((48, 80, 10, "w"), "up: 'w': no axis. Give one of x, y, z"),
    ],
)
def test_mistakes(arguments, message):
    with pytest.raises(InputError, match=message):
        sun_directions(*arguments)
