"""Fetch the Stanford dragon."""

from pathlib import Path

from neural_shadows.jobs import run_job
from neural_shadows.stanford import fetch_stanford_dragon


def main(job):
    fetch_stanford_dragon(Path(job.output.mesh))


if "snakemake" in globals():
    run_job(snakemake, main)
