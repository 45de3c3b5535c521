"""Find the depth bias of each network of an evaluation on held-out views."""

from pathlib import Path

from neural_shadows.evaluation.find_depth_biases import find_depth_biases
from neural_shadows.running.jobs import run_job


def main(job):
    params = job.params
    find_depth_biases(
        Path(job.input.mesh),
        dict(zip(params.networks, map(Path, job.input.weights), strict=True)),
        Path(job.output.found),
        view_sets=params.view_sets,
        first=params.first,
        last=params.last,
        frames=params.frames,
        reference=params.reference,
        device=params.device,
        precision=params.precision,
    )


if "snakemake" in globals():
    run_job(snakemake, main)
