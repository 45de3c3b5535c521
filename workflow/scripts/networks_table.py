"""Write a table of networks and shadow maps by scene."""

from pathlib import Path

from neural_shadows.reports.tables.networks import write_networks_table
from neural_shadows.running.jobs import run_job


def main(job):
    params = job.params
    scenes = list(dict.fromkeys(params.scenes))
    write_networks_table(
        [Path(path) for path in job.input.times],
        {scene: [Path(path) for path in paths] for scene, paths in params.batches.items()},
        dict(zip(params.networks, map(Path, job.input.weights), strict=True)),
        [Path(path) for path in job.input.training],
        [Path(path) for path in job.input.depth_biases],
        dict(zip(scenes, map(Path, job.input.meshes), strict=True)),
        Path(job.input.lpips),
        Path(job.output.csv),
        Path(job.output.md),
        title=params.title,
        rows=params.rows,
        scenes=params.scenes,
        procedural=params.procedural,
        scale=params.scale,
        width=params.width,
        height=params.height,
        reference=params.reference,
        seeds=params.seeds,
        given_biases=params.given_biases,
        seed=params.seed,
    )


if "snakemake" in globals():
    run_job(snakemake, main)
