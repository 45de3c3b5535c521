import numpy as np
import pytest

from neural_shadows.rays.sample_rays import sample_rays


@pytest.mark.parametrize("sampler", ["poisson_quadtree", "uniform_quadtree", "uniform"])
def test_threads_and_shards_change_no_byte(make_set, everything, tmp_path, sampler):
    contents = []
    for i, (cuts, threads) in enumerate([((0, 30), 1), ((0, 30), 2), ((0, 7, 8, 30), 2)]):
        folder = tmp_path / str(i)
        folder.mkdir()
        make_set(folder, cuts, threads, sampler=sampler)
        contents.append([array.tobytes() for array in everything(folder)])
    assert contents[0] == contents[1] == contents[2]


def test_seeds_and_directions_differ(mesh_ply, sampling, tmp_path):
    # The same direction twice: its points are drawn anew for each index.
    files = {"mesh_ply": mesh_ply, "directions_npy": tmp_path / "directions.npy"}
    np.save(files["directions_npy"], np.repeat(np.array([[0, 0, 1]], np.float32), 2, axis=0))
    drawn = []
    for seed in (3, 4):
        out = tmp_path / f"{seed}.npy"
        sample_rays(**files, origins_npy=out, sampling=sampling, seed=seed, first=0, last=2)
        drawn += [*np.load(out)]
    assert len({points.tobytes() for points in drawn}) == 4
