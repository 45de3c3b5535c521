"""Sample the rays of one shard of a ray set."""

from pathlib import Path

from neural_shadows.rays.sample_rays import make_rays
from neural_shadows.running.jobs import run_job


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
