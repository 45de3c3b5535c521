"""Write the page that shows a run."""

from pathlib import Path

from neural_shadows.reports.page import write_html_report
from neural_shadows.running.jobs import run_job


def paths_of(files):
    return {name: [Path(path) for path in paths] for name, paths in files.items()}


def main(job):
    params = job.params
    write_html_report(
        Path(job.output.html),
        Path(job.input.page[0]).parent,
        scale=params.scale,
        seed=params.seed,
        frames=params.frames,
        tables=[Path(path) for path in job.input.tables],
        figures=params.figures,
        beyond=params.beyond,
        claims=Path(job.input.claims[0]) if job.input.claims else None,
        pictures=paths_of(params.pictures),
        metrics=paths_of(params.metrics),
        meshes=dict(zip(params.scenes, map(Path, job.input.meshes), strict=True)),
        procedural=params.procedural,
        trainings=[Path(path) for path in job.input.trainings],
        lpips_json=Path(job.input.lpips),
        benchmarks=Path(params.benchmarks),
        folder=Path.cwd(),
    )


if "snakemake" in globals():
    run_job(snakemake, main)
