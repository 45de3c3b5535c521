"""Write a table of memory as CSV and Markdown."""

from pathlib import Path

from neural_shadows.reports.tables.memory import write_memory_table
from neural_shadows.running.jobs import run_job


def main(job):
    params = job.params
    write_memory_table(
        Path(job.input.mesh),
        dict(zip(params.networks, map(Path, job.input.weights), strict=True)),
        Path(job.input.published),
        Path(job.output.csv),
        Path(job.output.md),
        title=params.title,
        number=params.number,
        rows=params.rows,
        scale=params.scale,
    )


if "snakemake" in globals():
    run_job(snakemake, main)
