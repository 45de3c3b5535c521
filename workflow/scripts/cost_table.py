"""Write a table of costs as CSV and Markdown."""

from pathlib import Path

from neural_shadows.reports.tables.cost import write_cost_table
from neural_shadows.running.jobs import run_job


def main(job):
    write_cost_table(
        [Path(path) for path in job.input.costs],
        Path(job.output.csv),
        Path(job.output.md),
        title=job.params.title,
        scale=job.params.scale,
    )


if "snakemake" in globals():
    run_job(snakemake, main)
