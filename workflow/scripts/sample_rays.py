"""Sample the rays of one shard of a ray set."""

from pathlib import Path

from neural_shadows.jobs import run_job
from neural_shadows.ray_files import make_rays


def main(job):
    make_rays(
        Path(job.input.mesh),
        Path(job.input.directions),
        Path(job.output.origins),
        sampler=job.params.sampler,
        points_per_direction=job.params.points_per_direction,
        silhouette_resolution=job.params.silhouette_resolution,
        min_quad=job.params.min_quad,
        seed=job.params.seed,
        first=job.params.first,
        last=job.params.last,
        threads=job.threads,
    )


if "snakemake" in globals():
    run_job(snakemake, main)
