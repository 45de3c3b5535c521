"""Draw how costs grow."""

from pathlib import Path

from neural_shadows.reports.figures.cost import write_cost_figure
from neural_shadows.running.jobs import run_job


def main(job):
    write_cost_figure(
        [Path(path) for path in job.input.costs],
        Path(job.output.png),
        Path(job.output.svg),
        title=job.params.title,
        scale=job.params.scale,
    )


if "snakemake" in globals():
    run_job(snakemake, main)
