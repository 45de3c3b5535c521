"""Write a table of frame times, quality and size as CSV and Markdown."""

from pathlib import Path

from neural_shadows.jobs import run_job
from neural_shadows.performance_table import write_performance_table


def main(job):
    params = job.params
    write_performance_table(
        [Path(path) for path in job.input.times],
        {scene: [Path(path) for path in paths] for scene, paths in params.batches.items()},
        dict(zip(params.networks, map(Path, job.input.weights), strict=True)),
        [Path(path) for path in job.input.training],
        Path(job.input.published),
        Path(job.output.csv),
        Path(job.output.md),
        title=params.title,
        number=params.number,
        rows=params.rows,
        scenes=params.scenes,
        scale=params.scale,
        seed=params.seed,
    )


if "snakemake" in globals():
    run_job(snakemake, main)
