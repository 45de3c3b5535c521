"""Stage: how often a network's depths violate the labels' bounds [5.1]."""

from pathlib import Path
from typing import Any

from neural_shadows.evaluation.metric_files import write_metrics
from neural_shadows.evaluation.ray_network import open_network, take_constants
from neural_shadows.evaluation.references import References
from neural_shadows.evaluation.views import View
from neural_shadows.evaluation.violations import RANDOM, compare_depths, random_depths
from neural_shadows.meshes.prepared_mesh import read_prepared
from neural_shadows.networks.object_space.shadow_query import on_device
from neural_shadows.networks.object_space.sphere_rays import sphere_rays
from neural_shadows.rays.labels import dual_bounds
from neural_shadows.running.progress import progress_bar
from neural_shadows.running.stage import run_stage
from neural_shadows.scenes.tracing import Tracer


def count_violations(
    references: Path,
    weights: Path,
    constants_json: Path | None,
    mesh_ply: Path,
    violations_csv: Path,
    *,
    method: str,
    bias: float = 0.0,
    device: str = "auto",
    precision: str = "auto",
    threads: int = 1,
) -> None:
    """Count `Violations` of a batch of views, and of random depths, into a file of `write_metrics`.

    Args:
        references: of `render_references`.
        constants_json: of `tune`, for a depth bias found on held-out views.
        mesh_ply: prepared, for the labels.
        method: the network's name.
        bias: of the depth test without these constants, in sphere radii.

    Raises:
        InputError: an input file cannot be read.
    """
    network, dtype = open_network(weights, device, threads, precision)
    depth_bias = take_constants(network, constants_json) if constants_json else bias
    mesh = read_prepared(mesh_ply)
    tracer = Tracer(mesh.vertices, mesh.faces)
    batch = References(references)
    rows: list[dict[str, Any]] = []
    with progress_bar(len(batch), "views", f"count violations of {method}") as bar:
        for number, (frame, truth) in enumerate(batch):
            p, light = on_device(frame.p, frame.view.light, network.device)
            rays = sphere_rays(p, light)
            t_pred = network.depths(rays.origins, -light, dtype)
            # As methods answer it: a field's query is another than its depths.
            lit = network.points_lit(p, light, dtype)(depth_bias)[rays.index].cpu().numpy()
            t = (t_pred + depth_bias).cpu().numpy()
            bounds = dual_bounds(tracer, rays.origins.cpu().numpy(), -light.cpu().numpy())
            true = truth[frame.lit_side][rays.index.cpu().numpy()]
            own = [
                *frame.view.eye.tobytes(),
                *frame.view.light.tobytes(),
            ]  # of each view other numbers
            drawn = random_depths(rays.s.cpu().numpy(), rays.chord.cpu().numpy(), seed=own)
            counts = compare_depths(t, *bounds, lit, true)._asdict()
            of_random = compare_depths(drawn[0], *bounds, drawn[1], true)._asdict()
            counts |= {f"{RANDOM}{name}": count for name, count in of_random.items()}
            place = View(references, number, frame, truth, None).key(0) | {"method": method}
            rows += [place | {"metric": name, "value": count} for name, count in counts.items()]
            bar.update()
    write_metrics(violations_csv, rows)


if "snakemake" in globals():
    run_stage(snakemake, count_violations)
