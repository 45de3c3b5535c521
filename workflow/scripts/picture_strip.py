"""Draw the same viewpoints by every method of a table."""

from pathlib import Path

from neural_shadows.reports.figures.pictures import write_picture_strip
from neural_shadows.running.jobs import run_job


def main(job):
    write_picture_strip(
        [Path(path) for path in job.input.pictures],
        [Path(path) for path in job.input.metrics],
        Path(job.input.mesh),
        Path(job.output.png),
        Path(job.output.svg),
        title=job.params.title,
        rows=job.params.rows,
        scale=job.params.scale,
    )


if "snakemake" in globals():
    run_job(snakemake, main)
