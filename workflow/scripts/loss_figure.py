"""Draw training losses."""

from pathlib import Path

from neural_shadows.reports.figures.loss import write_loss_figure
from neural_shadows.running.jobs import run_job


def main(job):
    write_loss_figure(
        [Path(path) for path in job.input.losses],
        Path(job.output.png),
        Path(job.output.svg),
        title=job.params.title,
        labels=job.params.labels,
        scale=job.params.scale,
    )


if "snakemake" in globals():
    run_job(snakemake, main)
