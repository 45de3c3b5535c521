"""Draw quality and frame time over layer width."""

from pathlib import Path

from neural_shadows.jobs import run_job
from neural_shadows.width_figure import write_width_figure


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
