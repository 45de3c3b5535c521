"""In the other environment: how much of a spherical light the pixels of a scene see.

By Mitsuba's camera, its rays and its own samples of the light; lit from the side that is seen.
"""

import sys

import drjit as dr
import mitsuba as mi
import numpy as np


def main() -> None:
    given = np.load(sys.argv[1])
    mesh = mi.Mesh("mesh", len(given["vertices"]), len(given["faces"]))
    parts = mi.traverse(mesh)
    parts["vertex_positions"] = given["vertices"].ravel()
    parts["faces"] = given["faces"].astype(np.uint32).ravel()
    parts.update()
    width, height, samples = (int(given[key]) for key in ("width", "height", "samples"))
    scene = mi.load_dict(
        {
            "type": "scene",
            "mesh": mesh,
            "light": {
                "type": "sphere",
                "center": list(given["centre"]),
                "radius": float(given["radius"]),
                "emitter": {"type": "area", "radiance": 1.0},
            },
            "sensor": {
                "type": "perspective",
                "fov": float(given["fov"]),
                "fov_axis": "y",
                "to_world": mi.ScalarTransform4f().look_at(
                    *(list(given[key]) for key in ("eye", "target", "up"))
                ),
                "film": {"type": "hdrfilm", "width": width, "height": height},
            },
        }
    )
    random = np.random.default_rng(int(given["seed"]))
    seen = np.empty((len(given["places"]), height, width), np.int64)
    for place, (x, y) in enumerate(given["places"]):
        for row, column in np.ndindex(height, width):
            at = (column + x) / width, (row + y) / height
            seen[place, row, column] = _seen(scene, at, random.random((samples, 2)).tolist())
    np.savez(sys.argv[2], seen=seen)


def _seen(scene, at: tuple[float, float], drawn: list) -> int:
    """How many samples of the light are visible from what a camera's ray hits; −1 of the light."""
    ray, _ = scene.sensors()[0].sample_ray(0.0, 0.5, mi.ScalarPoint2f(*at), mi.ScalarPoint2f(0.5))
    hit = scene.ray_intersect(ray)
    if not hit.is_valid():
        return len(drawn)
    if hit.shape.is_emitter():
        return -1
    side = 1 if dr.dot(hit.n, ray.d) < 0 else -1
    normal, count = side * hit.n, 0
    for u in drawn:
        to_light, weight = scene.sample_emitter_direction(hit, mi.ScalarPoint2f(*u), True)
        count += weight[0] > 0 and dr.dot(normal, to_light.d) > 0
    return count


mi.set_variant("scalar_rgb")
main()
