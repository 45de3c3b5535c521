"""Two choices of the method in numbers, on the viewpoints of a finished run.

    python tests/benchmarks/clamp_and_reference.py results [--views 12]

1. How well the thesis's reference, a 32768² shadow map, agrees with exact shadow rays (PSNR).
2. What the clamp of s to the chord ℓ is worth in the network query (PSNR with and without).
"""

import argparse
from pathlib import Path

import numpy as np
import torch

from neural_shadows.evaluation.shadow_methods import REFERENCES, traced_method
from neural_shadows.metrics.psnr_ssim import psnr
from neural_shadows.networks.object_space.shadow_query import on_device, sphere_rays
from neural_shadows.networks.weight_file import load_network
from neural_shadows.rendering.gbuffer import render_gbuffer
from neural_shadows.rendering.shading import shade
from neural_shadows.rendering.viewpoints import draw_viewpoints
from neural_shadows.scenes.scene import open_scene


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("results", type=Path, help="folder of a finished run of table 4.3")
    parser.add_argument("--views", type=int, default=12, help="of each view set")
    parser.add_argument("--width", type=int, default=600)
    parser.add_argument("--height", type=int, default=400)
    parser.add_argument("--seed", type=int, default=2026)
    asked = parser.parse_args()
    mesh_ply = asked.results / "scenes/dragon/mesh.ply"
    scene = open_scene(mesh_ply, up="y", ground=True, light=LIGHT)
    weights = asked.results / "networks/dragon/weights.safetensors"
    network, dtype = open_network(weights, "cpu", 2)
    exact, large_map = (traced_method(REFERENCES[kind], scene) for kind in ("exact", "shadow_map"))

    values: dict[str, list[float]] = {"map": [], "clamped": [], "not clamped": []}
    width, height = arguments.width, arguments.height
    for view in draw_viewpoints(
        scene, ["shadow", "surface"], range(arguments.views), width / height, arguments.seed
    ):
        frame = render_gbuffer(scene, view, width, height)
        reference = shade(frame, exact(frame))
        values["map"].append(psnr(shade(frame, large_map(frame)), reference))
        p, light = on_device(frame.p, view.light, network.device)
        rays = sphere_rays(p, light)
        t_pred = network.depths(rays.origins, -light, dtype)
        for name, s in (("clamped", torch.minimum(rays.s, rays.chord)), ("not clamped", rays.s)):
            lit = torch.ones(len(p), dtype=torch.bool)
            lit[rays.index] = s <= t_pred
            values[name].append(psnr(shade(frame, frame.visibility(lit.numpy())), reference))
    print(f"mean PSNR in dB over {2 * arguments.views} views:")
    print(f"32768² map against exact rays: {np.mean(values['map']):.1f}")
    print(f"  lowest of a view: {np.min(values['map']):.1f}")
    print(f"network, s clamped to the chord: {np.mean(values['clamped']):.2f}")
    print(f"network, s not clamped: {np.mean(values['not clamped']):.2f}")


if __name__ == "__main__":
    main()
