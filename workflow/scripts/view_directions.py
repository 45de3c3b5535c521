"""Draw the view directions of a ray set."""

from pathlib import Path

from neural_shadows.jobs import run_job
from neural_shadows.view_directions import make_directions


def main(job):
    make_directions(
        Path(job.output.directions),
        sampler=job.params.sampler,
        directions=job.params.directions,
        seed=job.params.seed,
        light=job.params.light,
        up=job.params.up,
    )


if "snakemake" in globals():
    run_job(snakemake, main)
