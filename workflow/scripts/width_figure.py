"""Draw quality and frame time over layer width."""

from pathlib import Path

from neural_shadows.reports.figures.widths import write_width_figure
from neural_shadows.running.jobs import run_job


def main(job):
    write_width_figure(
        Path(job.input.table),
        Path(job.output.png),
        Path(job.output.svg),
        title=job.params.title,
        rows=job.params.rows,
        widths=job.params.widths,
        scale=job.params.scale,
    )


if "snakemake" in globals():
    run_job(snakemake, main)
