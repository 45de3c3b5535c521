"""What a coarser number format of the matrix products costs a trained network's answers.

    python tests/benchmarks/precision_of_queries.py --mesh results/scenes/dragon/mesh.ply
        --weights results/networks/dragon/weights.safetensors [--views 4]

Prints, against float32 on the rays of the viewpoints' points: the difference of predicted depths
in sphere radii (median, 90 %, root of the mean square), and the share of points that face the
light whose answer flips. Shading points lie 0.001 off their surface.
"""

import argparse
from pathlib import Path

import pandas as pd
import torch
from bench_queries import HEIGHT, SCENE, SEED, WIDTH

from neural_shadows.networks.compute import choose_device
from neural_shadows.networks.object_space.shadow_network import ShadowNetwork
from neural_shadows.networks.object_space.shadow_query import on_device, sphere_rays
from neural_shadows.networks.weight_file import load_network
from neural_shadows.rendering.gbuffer import GBuffer, render_gbuffer
from neural_shadows.rendering.viewpoints import draw_viewpoints
from neural_shadows.scenes.scene import open_scene

PRECISIONS = ("bfloat16", "float16")


def frames_of(mesh_ply: Path, views: int) -> list[GBuffer]:
    """Frames of the first viewpoints of both view sets."""
    scene = open_scene(mesh_ply, **SCENE)
    drawn = draw_viewpoints(scene, ["shadow", "surface"], range(views), WIDTH / HEIGHT, SEED)
    return [render_gbuffer(scene, view, WIDTH, HEIGHT) for view in drawn]


def differences(network: ShadowNetwork, frames: list[GBuffer]) -> pd.DataFrame:
    """A row for each of `PRECISIONS`: `median`, `share_90`, `rms` of |Δt|, and `flipped`."""
    errors = {precision: [] for precision in PRECISIONS}
    flips, points = dict.fromkeys(PRECISIONS, 0), 0
    for frame in frames:
        p, light = on_device(frame.p, frame.view.light, network.device)
        rays = sphere_rays(p, light)
        s = torch.minimum(rays.s, rays.chord)
        exact = network.depths(rays.origins, -light, torch.float32)
        points += len(p)
        for precision in PRECISIONS:
            t = network.depths(rays.origins, -light, getattr(torch, precision))
            errors[precision].append((t - exact).abs())
            flips[precision] += ((s <= t) != (s <= exact)).sum().item()
    rows = []
    for precision in PRECISIONS:
        error = torch.cat(errors[precision]).double().cpu().numpy()
        found = pd.Series(error).quantile([0.5, 0.9]).tolist()
        rows.append([precision, *found, float((error**2).mean() ** 0.5), flips[precision] / points])
    return pd.DataFrame(rows, columns=["precision", "median", "share_90", "rms", "flipped"])


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--mesh", type=Path, required=True, help="prepared")
    parser.add_argument("--weights", type=Path, required=True, help="of a trained network")
    parser.add_argument("--views", type=int, default=4, help="of each view set")
    given = parser.parse_args()
    torch.set_num_threads(1)
    network = load_network(given.weights)[0].to(choose_device("auto"))
    found = differences(network, frames_of(given.mesh, given.views))
    print(found.to_string(index=False, float_format="{:.3g}".format))


if __name__ == "__main__":
    main()
