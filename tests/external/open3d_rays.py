"""In the other environment: which rays are blocked, and where they first hit, by Open3D."""

import sys

import numpy as np
import open3d


def main() -> None:
    given = np.load(sys.argv[1])
    scene = open3d.t.geometry.RaycastingScene()
    scene.add_triangles(
        open3d.core.Tensor(given["vertices"]), open3d.core.Tensor(given["faces"].astype(np.uint32))
    )
    rays = open3d.core.Tensor(np.concatenate([given["points"], given["ways"]], axis=1))
    blocked = scene.test_occlusions(rays, tnear=0.0, tfar=float(given["end"])).numpy()
    hits = scene.cast_rays(rays)
    np.savez(sys.argv[2], blocked=blocked, t=hits["t_hit"].numpy())


main()
