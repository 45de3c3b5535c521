"""Write the description of a ray set beside its shards."""

from neural_shadows.jobs import run_job
from neural_shadows.ray_files import describe_rays


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
