import numpy as np
import pytest
from scipy.spatial import cKDTree

from neural_shadows.errors import InputError
from neural_shadows.rays.draw_directions import draw_directions
from neural_shadows.rays.sampling import SAMPLERS

ARC = {"domain": "single_axis", "axis": "z", "min_elevation_deg": 30}
CAP = {"domain": "sphere", "min_elevation_deg": 30}


def draw(tmp_path, directions, sampler="poisson_quadtree", **light):
    sampling = {"sampler": sampler, "directions": directions}
    draw_directions(directions_npy=tmp_path / "d.npy", sampling=sampling, seed=1, **light)
    return np.load(tmp_path / "d.npy")


def test_directions_are_poisson_disk_for_that_sampler_alone(tmp_path):
    closest = {}
    for sampler in SAMPLERS:
        directions = draw(tmp_path, 500, sampler)
        assert directions.shape == (500, 3) and directions.dtype == np.float32
        assert np.abs(np.linalg.norm(directions, axis=1) - 1).max() < 1e-6
        closest[sampler] = cKDTree(directions).query(directions, k=2)[0][:, 1].min()
    assert closest["poisson_quadtree"] > 0.11  # √(0.5 · 4π / 500)
    assert closest["uniform_quadtree"] == closest["uniform"] < 0.03


@pytest.mark.parametrize("sampler", ["poisson_quadtree", "uniform"])
def test_an_arc_s_directions_lie_on_it_and_fill_it(tmp_path, sampler):
    found = draw(tmp_path, sampler=sampler, directions=2000, light=ARC)
    assert found.shape == (2000, 3) and found.dtype == np.float32
    assert np.abs(found[:, 2]).max() < 1e-6  # across the axis
    assert np.abs(np.linalg.norm(found, axis=1) - 1).max() < 1e-6
    # The light comes from above, so that the directions point down; angles from the zenith.
    angle = np.degrees(np.arctan2(found[:, 0], -found[:, 1]))
    assert 59.5 < angle.max() <= 60 and -60 <= angle.min() < -59.5
    assert np.histogram(angle, 12, (-60, 60))[0] == pytest.approx(2000 / 12, rel=0.35)


def test_a_poisson_arc_has_gaps_of_r_to_2r_in_random_order(tmp_path):
    found = draw(tmp_path, directions=500, light=ARC)
    angle = np.arctan2(found[:, 0], -found[:, 1]).astype(float)
    gaps = np.diff(np.sort(angle))
    assert gaps.max() / gaps.min() < 2.01
    assert gaps.std() / gaps.mean() > 0.1  # and no regular grid
    # Shards are ranges of directions: each must span the arc.
    assert angle[:100].min() < -0.95 and angle[:100].max() > 0.95


@pytest.mark.parametrize(("up", "axis"), [("y", 1), ("z", 2)])
def test_a_cap_s_directions_are_below_and_poisson_disk(tmp_path, up, axis):
    found = draw(tmp_path, directions=500, light=CAP, up=up).astype(float)
    assert len(found) == 500
    assert (-found[:, axis] >= 0.4999).all()
    assert (-found[:, axis]).min() < 0.56  # down to the rim
    closest = cKDTree(found).query(found, k=2)[0][:, 1].min()
    assert closest > 0.9 * np.sqrt(0.5 * np.pi / 500)  # the cap's area is π
    uniform = draw(tmp_path, sampler="uniform", directions=500, light=CAP, up=up)
    assert (-uniform[:, axis] >= 0.4999).all()
    assert cKDTree(uniform).query(uniform, k=2)[0][:, 1].min() < 0.03


def test_wrong_arguments_are_named(tmp_path):
    wrong = [
        ({"sampler": "sobol", "directions": 5}, "sampler: 'sobol'.*poisson_quadtree"),
        ({"directions": 5, "light": ARC | {"axis": "y"}}, "light.axis: y is not horizontal"),
        ({"directions": 5, "light": {"domain": "moon", "min_elevation_deg": 1}}, "light.domain"),
        ({"directions": 5, "light": CAP | {"min_elevation_deg": 90}}, "min_elevation_deg: 90"),
    ]
    for settings, message in wrong:
        with pytest.raises(InputError, match=message):
            draw(tmp_path, **settings)
    assert list(tmp_path.iterdir()) == []
