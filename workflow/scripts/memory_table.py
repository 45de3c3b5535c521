"""Write a table of memory as CSV and Markdown."""

from pathlib import Path

from neural_shadows.jobs import run_job
from neural_shadows.memory_table import write_memory_table


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
