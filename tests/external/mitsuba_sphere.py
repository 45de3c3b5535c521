"""In the other environment: the ball's scene rendered with and without the ball, and their ratio."""

import sys

import mitsuba as mi
import numpy as np


def main() -> None:
    given = np.load(sys.argv[1])
    with_ball, without = (_rendered(given, ball) for ball in (True, False))
    np.savez(sys.argv[2], visibility=with_ball / without)


def _rendered(given, ball: bool) -> np.ndarray:
    half, side = given["width"] / 2, int(np.sqrt(given["samples"]))
    turned = mi.ScalarTransform4f()
    # From its left end on, as seen from above with z down.
    above = turned.look_at(origin=[half, 0.3, 0], target=[half, 0, 0], up=[0, 0, -1])
    film = {"type": "hdrfilm", "width": int(given["points"]), "height": 1}
    film |= {"rfilter": {"type": "box"}, "pixel_format": "luminance"}
    scene = {
        "type": "scene",
        "integrator": {"type": "direct", "emitter_samples": side, "bsdf_samples": 0},
        "sensor": {
            "type": "orthographic",
            "near_clip": 0.001,
            "far_clip": 5.0,
            "to_world": above @ turned.scale([half, half, 1]),
            "film": film,
            "sampler": {"type": "independent", "sample_count": side},
        },
        "floor": {"type": "rectangle", "to_world": turned.rotate([1, 0, 0], -90).scale([5, 5, 1])},
        "light": {
            "type": "sphere",
            "center": list(given["light"]),
            "radius": float(given["light_radius"]),
            "emitter": {"type": "area", "radiance": 1.0},
        },
    }
    if ball:
        radius = float(given["ball_radius"])
        scene["ball"] = {"type": "sphere", "center": list(given["ball"]), "radius": radius}
    return np.array(mi.render(mi.load_dict(scene), seed=int(ball))).ravel()


mi.set_variant("scalar_rgb")
main()
