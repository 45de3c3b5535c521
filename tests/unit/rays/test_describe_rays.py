import json

import numpy as np
import pytest

from neural_shadows.files.whole_files import sha256_of
from neural_shadows.rays.describe_rays import describe_rays


def test_the_description_counts_rays_by_their_hits(
    mesh_ply, ray_set, everything, sampling, tmp_path
):
    describe_rays(
        mesh_ply=mesh_ply,
        directions_npy=ray_set / "directions.npy",
        origins=[ray_set / f"origins.00{i}.npy" for i in (0, 1)],
        bounds=[ray_set / f"bounds.00{i}.npy" for i in (0, 1)],
        rays_json=tmp_path / "rays.json",
        sampling=sampling,
        seed=3,
    )
    content = json.loads((tmp_path / "rays.json").read_text())
    origins, directions, t_lb, t_ub = everything(ray_set)
    chord = -2 * np.sum(origins.astype(float) * directions, axis=1)
    missed = np.isinf(t_ub) & (np.abs(t_lb - chord) < 1e-6)
    assert 0.1 < content["misses"] == pytest.approx(missed.mean(), abs=1e-12)
    once = np.isinf(t_ub) & ~missed
    assert 0.001 < content["one_hit"] == pytest.approx(once.mean(), abs=1e-12)
    assert content["mesh_sha256"] == sha256_of(mesh_ply)
    assert len(content["sha256"]) == 5
    for file, digest in content["sha256"].items():
        assert digest == sha256_of(ray_set / file)
    expected = sampling | {"rays": 12_000, "shards": 2, "seed": 3, "second_hit_step": 2e-5}
    assert content.items() >= expected.items()
