"""Make a procedural mesh."""

from neural_shadows.meshes.generate_mesh import generate_mesh
from neural_shadows.running.jobs import run_job


def main(job):
    generate_mesh(job.output.mesh, **job.params.mesh)


if "snakemake" in globals():
    run_job(snakemake, main)
