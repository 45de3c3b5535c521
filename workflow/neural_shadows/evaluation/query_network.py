"""Stage: a network's visibility of a batch of views.

Separate from `evaluate`, so that metrics, most of the time and on a CPU, hold no GPU.
"""

from pathlib import Path

import numpy as np

from neural_shadows.evaluation.answers import write_answers
from neural_shadows.evaluation.ray_network import open_network, take_constants
from neural_shadows.evaluation.references import References
from neural_shadows.evaluation.violations import Violations, count_violations
from neural_shadows.meshes.prepared_mesh import read_prepared
from neural_shadows.networks.object_space.shadow_query import on_device
from neural_shadows.networks.object_space.sphere_rays import sphere_rays
from neural_shadows.rays.labels import dual_bounds
from neural_shadows.running.progress import progress_bar
from neural_shadows.running.stage import run_stage
from neural_shadows.scenes.tracing import Tracer


def query_network(
    references: Path,
    weights: Path,
    constants_json: Path | None,
    mesh_ply: Path,
    answers: Path,
    *,
    method: str,
    bias: float | str | None = None,
    violations: bool = False,
    device: str = "auto",
    precision: str = "auto",
    threads: int = 1,
) -> None:
    """Write a network's visibilities; on request, violations of its depths.

    Args:
        references: of `render_references`.
        constants_json: of `tune`, where `bias` is `held_out`.
        mesh_ply: prepared, for the labels.
        answers: see `write_answers`.
        method: the network's name.
        bias: of the depth test, in sphere radii, or `held_out`.
        violations: count `Violations` too, which takes a CPU two more rays for each point.

    Raises:
        InputError: an input file cannot be read.
    """
    network, dtype = open_network(weights, device, threads, precision)
    depth_bias = take_constants(network, constants_json) if constants_json else bias or 0.0
    tracer = None
    if violations:
        mesh = read_prepared(mesh_ply)
        tracer = Tracer(mesh.vertices, mesh.faces)
    batch = References(references)
    lit_points: list[np.ndarray] = []
    counted: list[Violations] = []
    with progress_bar(len(batch), "views", f"query {method}") as bar:
        for frame, truth in batch:
            p, light = on_device(frame.p, frame.view.light, network.device)
            rays, t_pred = sphere_rays(p, light), None
            if tracer:
                t_pred = network.depths(rays.origins, -light, dtype)
            lit = network.points_lit(p, light, dtype, t_pred)(depth_bias)
            lit_points.append(lit.cpu().numpy())
            if tracer:
                index = rays.index.cpu().numpy()
                t = (t_pred + depth_bias).cpu().numpy()
                bounds = dual_bounds(tracer, rays.origins.cpu().numpy(), -light.cpu().numpy())
                true = truth[frame.lit_side][index]
                counted.append(count_violations(t, *bounds, lit_points[-1][index], true))
            bar.update()
    named = {str(number): points for number, points in enumerate(lit_points)}
    write_answers(answers, named, np.array(counted, np.int64) if tracer else None)


if "snakemake" in globals():
    run_stage(snakemake, query_network)
