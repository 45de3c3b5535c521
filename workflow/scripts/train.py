"""Train one shadow network."""

from pathlib import Path

from neural_shadows.files.whole_files import read_json
from neural_shadows.rays.ray_set import RaySet
from neural_shadows.running.jobs import run_job
from neural_shadows.training.checkpoints import UNFINISHED
from neural_shadows.training.train import train


def main(job):
    params = job.params
    train(
        RaySet(job.input.directions, job.input.origins, job.input.bounds),
        Path(job.output.weights),
        Path(job.output.loss),
        Path(job.output.record),
        name=job.wildcards.experiment,
        network=params.network,
        steps=params.steps,
        batch_size=params.batch_size,
        learning_rate=params.learning_rate,
        schedule=params.schedule,
        loss=params.loss,
        seed=params.seed,
        mesh_ply=next(map(Path, job.input.mesh), None),
        data=read_json(job.input.description),
        state_folder=Path(job.output.weights).parents[1] / UNFINISHED,
        device=params.device,
        precision=params.precision,
        threads=job.threads,
    )


if "snakemake" in globals():
    run_job(snakemake, main)
