"""Draw a prepared scene, its bounding sphere and a quadtree."""

from pathlib import Path

from neural_shadows.reports.figures.scene import preview_scene
from neural_shadows.running.jobs import run_job


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
