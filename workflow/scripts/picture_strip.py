"""Draw the same viewpoints by every method of a table."""

from pathlib import Path

from neural_shadows.jobs import run_job
from neural_shadows.table_report import write_picture_strip


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
