"""Write a comparison table as CSV and Markdown."""

from pathlib import Path

from neural_shadows.reports.tables.comparison import write_table_report
from neural_shadows.running.jobs import run_job


def main(job):
    params = job.params
    write_table_report(
        [Path(path) for path in job.input.metrics],
        Path(job.input.mesh),
        [Path(path) for path in job.input.training],
        [Path(path) for path in job.input.depth_biases],
        Path(job.input.lpips),
        Path(job.input.published),
        Path(job.output.csv),
        Path(job.output.md),
        title=params.title,
        number=params.number,
        rows=params.rows,
        scale=params.scale,
        width=params.width,
        height=params.height,
        reference=params.reference,
        procedural=params.procedural,
        seed=params.seed,
    )


if "snakemake" in globals():
    run_job(snakemake, main)
