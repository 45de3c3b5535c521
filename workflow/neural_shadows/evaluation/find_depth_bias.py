"""The stage that finds the depth bias with which a network errs least, on views no table shows.

Shadow maps have one for the same reason: a depth that is a little short puts lit points in the
shadow of the very surface they lie on.
"""

from pathlib import Path

import numpy as np

from neural_shadows.evaluation.references import References
from neural_shadows.evaluation.shadow_methods import open_network
from neural_shadows.files.whole_files import write_json
from neural_shadows.metrics.shadow_error import shadow_error
from neural_shadows.networks.object_space.shadow_query import lit_points, on_device, sphere_rays
from neural_shadows.running.progress import progress_bar
from neural_shadows.running.stage import run_stage

# In sphere radii: none, and three an octave from half the shading offset to an eighth.
BIASES = (0.0, *(float(b) for b in np.round(0.0005 * 2 ** (np.arange(25) / 3), 5)))


def find_depth_bias(
    references: Path,
    weights: Path,
    depth_bias_json: Path,
    *,
    device: str = "auto",
    threads: int = 1,
) -> None:
    """Write the bias of `BIASES` with the least shadow error over a batch, and all errors.

    Args:
        references: what `render_references` wrote of views that no evaluation uses.

    Raises:
        InputError: an input file cannot be read.
    """
    network, dtype = open_network(weights, device, threads)
    batch = References(references)
    # Sums over views of (false shadow, light leak) by bias.
    sums = np.zeros((len(BIASES), 2))
    with progress_bar(len(batch), "views", f"find depth bias of {weights.parent.name}") as bar:
        for frame, truth in batch:
            p, light = on_device(frame.p, frame.view.light, network.device)
            rays = sphere_rays(p, light)
            t_pred = network.depths(rays.origins, -light, dtype)
            for i, bias in enumerate(BIASES):
                lit = lit_points(rays, t_pred, len(p), bias).cpu().numpy()
                error = shadow_error(frame.visibility(lit), truth)
                sums[i] += error.false_shadow, error.light_leak
            bar.update()
    errors = [
        {"depth_bias": bias, "false_shadow": false_shadow, "light_leak": light_leak}
        for bias, (false_shadow, light_leak) in zip(BIASES, (sums / len(batch)).tolist())
    ]
    best = BIASES[int(sums.sum(1).argmin())]
    write_json(depth_bias_json, {"depth_bias": best, "views": len(batch), "errors": errors})


if "snakemake" in globals():
    run_stage(snakemake, find_depth_bias)
