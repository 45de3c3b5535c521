"""Test the thesis's claims on this run's data."""

from pathlib import Path

from neural_shadows.reports.claims import write_claims
from neural_shadows.running.jobs import run_job


def paths_of(files):
    return {name: [Path(path) for path in paths] for name, paths in files.items()}


def main(job):
    params = job.params
    write_claims(
        Path(job.output.csv),
        Path(job.output.md),
        claims=params.claims,
        metrics=paths_of(params.metrics),
        scenes=params.scenes,
        losses={name: Path(path) for name, path in params.losses.items()},
        frame_times=paths_of(params.times),
        scale=params.scale,
        samples=params.samples,
        seed=params.seed,
    )


if "snakemake" in globals():
    run_job(snakemake, main)
