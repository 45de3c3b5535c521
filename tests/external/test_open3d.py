"""Our rays beside those of Open3D, which asks an Embree of its own."""

import numpy as np
from shapes import bumpy_sphere, prepared

from neural_shadows.scenes.tracing import NEARLY_ALL

COUNT = 200_000


def test_our_rays(run_outside, measured):
    mesh, tracer = prepared(bumpy_sphere(6))
    rng = np.random.default_rng(3)
    face = np.sort(rng.integers(len(mesh.faces), size=COUNT // 2))
    starts = mesh.vertices[mesh.faces[face]].mean(1) + 1e-4 * mesh.face_normals[face]
    to_light = [2, 3, 1] - starts + rng.normal(scale=0.1, size=starts.shape)
    around = rng.uniform(-1.5, 1.5, (COUNT // 2, 3))
    points = np.float32(np.concatenate([starts, around]))
    ways = np.float32(np.concatenate([to_light, rng.uniform(-1, 1, around.shape) - around]))
    found = run_outside(
        "open3d_rays.py",
        **{"vertices": mesh.vertices, "faces": mesh.faces, "points": points, "ways": ways},
        end=np.float32(NEARLY_ALL),
    )
    blocked, (t, _) = tracer.blocked(points, ways), tracer.first_hit(points, ways)
    unlike = np.sum(blocked != found["blocked"])
    hit = np.isfinite(t) & np.isfinite(found["t"])
    off = np.abs(t[hit] - found["t"][hit]) / t[hit]
    measured(
        f"rays beside Open3D: {unlike} of {COUNT} answers unlike; first hits: "
        f"{np.sum(np.isfinite(t) != np.isfinite(found['t']))} unlike, mean {off.mean():.1e}, rms "
        f"{np.sqrt(np.mean(off**2)):.1e}, largest {off.max():.1e} of the distance"
    )
    assert 0.2 < blocked.mean() < 0.8
    assert unlike <= 2 and np.array_equal(np.isfinite(t), np.isfinite(found["t"]))
    assert np.quantile(off, 0.999) < 1e-5
