"""Draw a prepared scene, its bounding sphere and a quadtree."""

from pathlib import Path

from neural_shadows.jobs import run_job
from neural_shadows.preview import preview_scene


def main(job):
    preview_scene(
        Path(job.input.mesh),
        Path(job.input.report),
        Path(job.output.picture),
        up=job.params.up,
        ground=job.params.ground,
    )


if "snakemake" in globals():
    run_job(snakemake, main)
