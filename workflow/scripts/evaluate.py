"""Render one batch of viewpoints with every method and measure it."""

from pathlib import Path

from neural_shadows.evaluation import evaluate
from neural_shadows.jobs import run_job


def main(job):
    params = job.params
    evaluate(
        Path(job.input.mesh),
        Path(job.input.lpips),
        dict(zip(params.networks, map(Path, job.input.weights), strict=True)),
        Path(job.output.metrics),
        Path(job.output.pictures),
        shadow_maps=params.shadow_maps,
        view_set=job.wildcards.view_set,
        first=params.first,
        last=params.last,
        up=params.up,
        ground=params.ground,
        light=params.light,
        width=params.width,
        height=params.height,
        reference=params.reference,
        depth_bias=params.depth_bias,
        seed=params.seed,
        device=params.device,
        precision=params.precision,
        threads=job.threads,
    )


if "snakemake" in globals():
    run_job(snakemake, main)
