"""Time frames of a scene by each method of a table."""

from pathlib import Path

from neural_shadows.evaluation.measure_frame_times import measure_frame_times
from neural_shadows.running.jobs import run_job


def main(job):
    params = job.params
    measure_frame_times(
        Path(job.input.mesh),
        dict(zip(params.networks, map(Path, job.input.weights), strict=True)),
        Path(job.output.times),
        scene_name=job.wildcards.scene,
        shadow_maps=params.shadow_maps,
        view_sets=params.view_sets,
        frames=params.frames,
        repeats=params.repeats,
        warm_up=params.warm_up,
        device=params.device,
        precision=params.precision,
    )


if "snakemake" in globals():
    run_job(snakemake, main)
