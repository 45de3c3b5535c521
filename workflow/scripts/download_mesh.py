"""Fetch the Stanford dragon."""

from pathlib import Path

from neural_shadows.meshes.download_mesh import fetch_stanford_dragon
from neural_shadows.running.jobs import run_job


def main(job):
    fetch_stanford_dragon(Path(job.output.mesh))


if "snakemake" in globals():
    run_job(snakemake, main)
