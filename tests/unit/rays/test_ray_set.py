import shutil

import numpy as np
import pytest
from rays import open_rays

from neural_shadows.errors import InputError


def test_rays_of_a_set_are_as_the_contract_says(ray_set, everything):
    rays = open_rays(ray_set)
    assert (rays.count, rays.points_per_direction) == (30 * 400, 400)
    assert [len(origins) for origins in rays.origins] == [11, 19]
    origins, directions, t_lb, t_ub = everything(ray_set)
    assert all(array.dtype == np.float32 for array in (origins, directions, t_lb, t_ub))
    assert np.array_equal(directions, np.repeat(rays.directions, 400, axis=0))
    for vectors in (origins, directions):
        assert np.abs(np.linalg.norm(vectors.astype(float), axis=1) - 1).max() < 1e-6
    assert (np.sum(origins.astype(float) * directions, axis=1) < 0).all()
    for part, stored in ((origins, rays.origins), (np.stack([t_lb, t_ub], 1), rays.bounds)):
        assert np.array_equal(part, np.concatenate(stored).reshape(part.shape))


def test_gather_finds_rays_across_shards(ray_set, everything):
    rays, whole = open_rays(ray_set), everything(ray_set)
    edges = np.array([11 * 400, 11 * 400 - 1, rays.count - 1, 0])
    for indices in (np.random.default_rng(0).integers(rays.count, size=5000), edges, edges[:0]):
        for found, stored in zip(rays.gather(indices), whole, strict=True):
            assert np.array_equal(found, stored[indices])


def cut(path):
    path.write_bytes(path.read_bytes()[:-100])


def pickled(path):
    np.save(path, np.array([{}], dtype=object), allow_pickle=True)


def as_float64(path):
    np.save(path, np.load(path).astype(np.float64))


def one_less(path):
    np.save(path, np.load(path)[:-1])


@pytest.mark.parametrize("name", ["directions", "origins.001", "bounds.000"])
@pytest.mark.parametrize("damage", [cut, pickled, as_float64, one_less])
def test_damaged_files_are_named(ray_set, tmp_path, name, damage):
    folder = shutil.copytree(ray_set, tmp_path / "rays")
    damage(folder / f"{name}.npy")
    # A shard that lost directions is missed at its bounds.
    blamed = name.replace("origins", "bounds") if damage is one_less else name
    with pytest.raises(InputError, match=f"{blamed}.npy: .* run again"):
        open_rays(folder)
