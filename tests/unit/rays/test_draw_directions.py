import numpy as np
import pytest
from scipy.spatial import cKDTree

from neural_shadows.rays.draw_directions import draw_directions

ARC = {"domain": "single_axis", "axis": "z", "min_elevation_deg": 30}
CAP = {"domain": "sphere", "min_elevation_deg": 30}


def draw(tmp_path, directions, sampler="poisson_quadtree", **light):
    sampling = {"sampler": sampler, "directions": directions}
    draw_directions(directions_npy=tmp_path / "d.npy", sampling=sampling, seed=1, **light)
    found = np.load(tmp_path / "d.npy")
    assert found.shape == (directions, 3) and found.dtype == np.float32
    assert np.abs(np.linalg.norm(found, axis=1) - 1).max() < 1e-6
    return found


def closest(directions):
    return cKDTree(directions).query(directions, k=2)[0][:, 1].min()


@pytest.mark.parametrize(
    ("sampler", "least", "most"),
    [("poisson_quadtree", 0.11, 0.2), ("uniform_quadtree", 0, 0.03), ("uniform", 0, 0.03)],
)
def test_directions_are_poisson_disk_for_that_sampler_alone(tmp_path, sampler, least, most):
    assert least < closest(draw(tmp_path, 500, sampler)) < most  # √(0.5 · 4π / 500) = 0.11


@pytest.mark.parametrize("sampler", ["poisson_quadtree", "uniform"])
def test_an_arc_s_directions_lie_on_it_and_fill_it(tmp_path, sampler):
    found = draw(tmp_path, 2000, sampler, light=ARC).astype(float)
    assert np.abs(found[:, 2]).max() < 1e-6  # across the axis
    # The light comes from above, so that the directions point down; angles from the zenith.
    angle = np.degrees(np.arctan2(found[:, 0], -found[:, 1]))
    assert 59.5 < angle.max() <= 60 and -60 <= angle.min() < -59.5
    assert np.histogram(angle, 12, (-60, 60))[0] == pytest.approx(2000 / 12, rel=0.35)
    if sampler == "poisson_quadtree":
        gaps = np.diff(np.sort(angle))
        assert gaps.max() / gaps.min() < 2.02
        assert gaps.std() / gaps.mean() > 0.1  # and no regular grid
        # Shards are ranges of directions: each must span the arc.
        assert angle[:100].min() < -54 and angle[:100].max() > 54


@pytest.mark.parametrize(("up", "axis"), [("y", 1), ("z", 2)])
def test_a_cap_s_directions_are_below_and_poisson_disk(tmp_path, up, axis):
    found = draw(tmp_path, 500, light=CAP, up=up)
    assert 0.4999 <= (-found[:, axis]).min() < 0.56  # down to the rim
    assert closest(found) > 0.9 * np.sqrt(0.5 * np.pi / 500)  # the cap's area is π
    uniform = draw(tmp_path, 500, "uniform", light=CAP, up=up)
    assert (-uniform[:, axis] >= 0.4999).all()
    assert closest(uniform) < 0.03
