"""Measure what the stages cost at one size."""

from pathlib import Path

from neural_shadows.evaluation.measure_cost import measure_cost
from neural_shadows.running.jobs import run_job


def main(job):
    measure_cost(
        Path(job.output.cost),
        over=job.wildcards.over,
        value=int(job.wildcards.value),
        seed=job.params.seed,
        device=job.params.device,
        precision=job.params.precision,
        threads=job.threads,
    )


if "snakemake" in globals():
    run_job(snakemake, main)
