"""Draw training losses."""

from pathlib import Path

from neural_shadows.jobs import run_job
from neural_shadows.loss_figure import write_loss_figure


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
