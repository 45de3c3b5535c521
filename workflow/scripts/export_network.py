"""Export one trained network as ONNX."""

from pathlib import Path

from neural_shadows.running.jobs import run_job
from neural_shadows.viewer.export_network import export_network


def main(job):
    export_network(
        Path(job.input.weights),
        Path(job.input.mesh),
        next(map(Path, job.input.depth_biases), None),
        job.params.depth_bias,
        Path(job.output.onnx),
        Path(job.output.conventions),
    )


if "snakemake" in globals():
    run_job(snakemake, main)
