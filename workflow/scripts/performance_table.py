"""Write a table of frame times, quality and size as CSV and Markdown."""

from pathlib import Path

from neural_shadows.reports.tables.frame_times import write_performance_table
from neural_shadows.running.jobs import run_job


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
