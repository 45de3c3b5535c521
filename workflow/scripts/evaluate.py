"""Render one batch of viewpoints with every method and measure it."""

from pathlib import Path

from neural_shadows.evaluation.depth_biases import biases_by_method
from neural_shadows.evaluation.evaluate import evaluate
from neural_shadows.evaluation.method_names import biased_key
from neural_shadows.running.jobs import run_job


def main(job):
    params = job.params
    if job.input.depth_biases:
        found = biases_by_method(map(Path, job.input.depth_biases))
        depth_biases = {method: found[method] for method in map(biased_key, params.networks)}
    else:
        depth_biases = dict.fromkeys(params.networks, params.depth_bias)
    evaluate(
        Path(job.input.mesh),
        Path(job.input.lpips),
        dict(zip(depth_biases, map(Path, job.input.weights), strict=True)),
        depth_biases,
        Path(job.output.metrics),
        Path(job.output.pictures),
        shadow_maps=params.shadow_maps,
        view_set=job.wildcards.view_set,
        first=params.first,
        last=params.last,
        frames=params.frames,
        reference=params.reference,
        device=params.device,
        precision=params.precision,
        threads=job.threads,
    )


if "snakemake" in globals():
    run_job(snakemake, main)
