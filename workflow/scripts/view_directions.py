"""Draw the view directions of a ray set."""

from pathlib import Path

from neural_shadows.rays.draw_directions import make_directions
from neural_shadows.running.jobs import run_job


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
