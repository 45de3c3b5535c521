"""Draw quality over costs of a scene of a table of networks."""

from pathlib import Path

from neural_shadows.reports.figures.fronts import write_fronts_figure
from neural_shadows.running.jobs import run_job


def main(job):
    params = job.params
    write_fronts_figure(
        Path(job.input.table),
        Path(job.output.png),
        Path(job.output.svg),
        title=params.title,
        scene=params.scene,
        rows=params.rows,
        scale=params.scale,
    )


if "snakemake" in globals():
    run_job(snakemake, main)
