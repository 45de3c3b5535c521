"""The depth bias with which a network errs least, found on views that no table shows.

Shadow maps have one for the same reason: a depth that is a little short puts lit points in the
shadow of the very surface they lie on.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import torch

from neural_shadows.evaluation.shadow_methods import reference_of
from neural_shadows.files.whole_files import write_json
from neural_shadows.metrics.shadow_error import shadow_error
from neural_shadows.networks.compute import choose_device, choose_dtype
from neural_shadows.networks.object_space.shadow_query import lit_points, on_device, sphere_rays
from neural_shadows.networks.weight_file import load_network
from neural_shadows.rendering.scene_frames import open_scene
from neural_shadows.rendering.shading import visibility
from neural_shadows.running.progress import progress_bar

# In sphere radii: none, and three an octave from half the shading offset to an eighth.
BIASES = (0.0, *(float(b) for b in np.round(0.0005 * 2 ** (np.arange(25) / 3), 5)))


def find_depth_biases(
    mesh_ply: Path,
    weights: Mapping[str, Path],
    found_json: Path,
    *,
    view_sets: Sequence[str],
    first: int,
    last: int,
    frames: Mapping[str, Any],
    reference: str,
    device: str = "auto",
    precision: str = "auto",
) -> None:
    """Write the bias of `BIASES` with the least shadow error for each network, and all errors.

    Args:
        weights: weight files by the name of their experiment.
        view_sets, first, last: viewpoints `first` to `last` (exclusive) of each set.
        frames: how they are drawn and rendered, see `open_scene`.
        reference: `exact` or `shadow_map`.

    Raises:
        InputError: an input file is not whole, or a setting does not fit the scene.
    """
    torch.set_num_threads(1)
    scene = open_scene(mesh_ply, **frames)
    reference_lit = reference_of(scene.mesh, scene.tracer, reference)
    chosen = choose_device(device)
    dtype = choose_dtype(precision, chosen)
    networks = {name: load_network(path)[0].to(chosen) for name, path in weights.items()}
    viewpoints = scene.viewpoints(view_sets, range(first, last))
    # Sums over views of (false shadow, light leak) by bias.
    errors = {name: np.zeros((len(BIASES), 2)) for name in networks}
    with progress_bar(len(viewpoints), "views", "depth biases") as bar:
        for view in viewpoints:
            points = scene.points(view)
            truth = visibility(points, reference_lit(points))
            everything = np.ones(len(points.pixel), bool)
            p, light = on_device(points.p, points.light, chosen)
            rays = sphere_rays(p, light)
            for name, network in networks.items():
                t_pred = network.depths(rays.origins, -light, dtype)
                for i, bias in enumerate(BIASES):
                    lit = lit_points(rays, t_pred, len(p), bias).cpu().numpy()
                    error = shadow_error(visibility(points, lit), truth, everything)
                    errors[name][i] += error.false_shadow, error.light_leak
            bar.update()
    write_json(
        found_json,
        {
            name: {
                "depth_bias": BIASES[int(sums.sum(1).argmin())],
                "views": len(viewpoints),
                "errors": [
                    {"depth_bias": bias, "false_shadow": false_shadow, "light_leak": light_leak}
                    for bias, (false_shadow, light_leak) in zip(
                        BIASES, (sums / len(viewpoints)).tolist(), strict=True
                    )
                ],
            }
            for name, sums in errors.items()
        },
    )
