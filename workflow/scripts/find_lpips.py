"""Find out whether LPIPS can be computed here."""

from pathlib import Path

from neural_shadows.jobs import run_job
from neural_shadows.lpips_stage import find_lpips


def main(job):
    find_lpips(Path(job.output.found), net=job.params.net, trunk=job.params.trunk)


if "snakemake" in globals():
    run_job(snakemake, main)
