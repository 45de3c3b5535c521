"""Draw a picture of how the method works."""

from pathlib import Path

from neural_shadows.reports.figures.method import draw_method_figure
from neural_shadows.running.jobs import run_job


def main(job):
    draw_method_figure(
        job.params.kind,
        Path(job.input.mesh),
        Path(job.input.report),
        Path(job.output.png),
        Path(job.output.svg),
        title=job.params.title,
        up=job.params.up,
        sampling=job.params.sampling,
        seed=job.params.seed,
    )


if "snakemake" in globals():
    run_job(snakemake, main)
