"""Write the description of a ray set beside its shards."""

from neural_shadows.rays.describe_rays import describe_rays
from neural_shadows.running.jobs import run_job


def main(job):
    describe_rays(
        job.output.description,
        mesh_ply=job.input.mesh,
        directions_npy=job.input.directions,
        origins_npys=job.input.origins,
        bounds_npys=job.input.bounds,
        sampler=job.params.sampler,
        silhouette_resolution=job.params.silhouette_resolution,
        min_quad=job.params.min_quad,
        seed=job.params.seed,
    )


if "snakemake" in globals():
    run_job(snakemake, main)
