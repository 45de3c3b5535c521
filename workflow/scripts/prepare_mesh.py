"""Clean a mesh and map its minimal bounding sphere to the unit sphere."""

from pathlib import Path

from neural_shadows.meshes.prepare_mesh import prepare_mesh
from neural_shadows.running.jobs import run_job


def main(job):
    prepare_mesh(
        Path(job.input.source),
        Path(job.output.mesh),
        Path(job.output.report),
        name=job.params.name,
    )


if "snakemake" in globals():
    run_job(snakemake, main)
