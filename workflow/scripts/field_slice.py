"""Draw a slice through an occupancy field."""

from pathlib import Path

from neural_shadows.reports.figures.field_slice import write_field_slice
from neural_shadows.running.jobs import run_job


def main(job):
    params = job.params
    write_field_slice(
        Path(job.input.mesh),
        Path(job.input.weights),
        Path(job.output.png),
        Path(job.output.svg),
        title=params.title,
        up=params.up,
    )


if "snakemake" in globals():
    run_job(snakemake, main)
