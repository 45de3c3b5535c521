"""Trace the labels of one shard of a ray set."""

from pathlib import Path

from neural_shadows.rays.label_rays import make_labels
from neural_shadows.running.jobs import run_job


def main(job):
    make_labels(
        Path(job.input.mesh),
        Path(job.input.directions),
        Path(job.input.origins),
        Path(job.output.bounds),
        seed=job.params.seed,
        first=job.params.first,
        last=job.params.last,
        threads=job.threads,
    )


if "snakemake" in globals():
    run_job(snakemake, main)
