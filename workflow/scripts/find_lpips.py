"""Find out whether LPIPS can be computed here."""

from pathlib import Path

from neural_shadows.metrics.find_lpips import find_lpips
from neural_shadows.running.jobs import run_job


def main(job):
    find_lpips(Path(job.output.found), net=job.params.net, trunk=job.params.trunk)


if "snakemake" in globals():
    run_job(snakemake, main)
