"""What a run takes on a cluster, from what the jobs of another run took."""

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import pandas as pd
from tabulate import tabulate

from neural_shadows.errors import InputError
from neural_shadows.files.csv_file import read_csv
from neural_shadows.layout.layout import Layout
from neural_shadows.running.benchmark_file import read_seconds

# Rules whose jobs compute on `compute.threads` cores; those of the others on one.
MANY_CORES = ("sample_rays", "label_rays", "train", "frame_times", "measure_cost")

# Rules whose jobs run where Snakemake itself runs.
LOCAL = ("download_mesh", "find_lpips")

RAY_BYTES = 12 + 8  # origin, and lower and upper bound, in float32

UNITS = {
    "generate_mesh": "meshes",
    "sample_rays": "rays",
    "label_rays": "rays",
    "train": "samples",
    "find_depth_biases": "pixels",
    "evaluate": "pixels",
    "frame_times": "pixels",
}


# Names of files that say nothing of which job of its rule made them.
_FILES = {"generated", "origins", "bounds", "weights", "loss", "training", "depth_biases"}


class Job(NamedTuple):
    """A job, by its rule and its name in logs and benchmark files (`dragon.shadow.000`)."""

    rule: str
    name: str

    @classmethod
    def of_output(cls, layout: Layout, rule: str, output: str) -> "Job":
        """The job that makes a file: `dragon.shadow.000` for evaluations/dragon/shadow.000.csv."""
        for folder in (layout.results, layout.reports):
            output = output.removeprefix(f"{folder}/")
        *folders, file = output.split("/")
        parts = [part for part in file.split(".")[:-1] if part not in _FILES]
        return cls(rule, ".".join([*folders[1:], *parts]))


def read_measured(path: str | Path) -> dict[Job, float]:
    """Seconds of each job of a run.

    Args:
        path: the folder of Snakemake's benchmark files of the run (`results/benchmarks`), or a
            CSV with the columns `rule`, `job` and `seconds`.

    Raises:
        InputError: there is no such file or folder, nothing in it, or a file is not whole.
    """
    path = Path(path)
    if path.is_dir():
        files = sorted(path.glob("*/*.tsv"))
        found = {Job(file.parent.name, file.stem): read_seconds(file).mean() for file in files}
    elif path.is_file():
        try:
            table = read_csv(path, {"rule": "str", "job": "str", "seconds": "float64"}, others=True)
        except (OSError, ValueError) as error:
            raise InputError(f"{path}: no times of jobs ({error})") from error
        if table.isna().any(axis=None):
            raise InputError(f"{path}: no times of jobs (a value is missing)")
        found = {Job(row.rule, row.job): row.seconds for row in table.itertuples()}
    else:
        raise InputError(f"{path}: no such file or folder; name a run's results/benchmarks")
    if not found:
        raise InputError(f"{path}: no benchmark files there; run the workflow first")
    return found


def work_of(layout: Layout, job: Job) -> float:
    """How much a job does, in the unit of its rule (`UNITS`).

    Pixels are those that are rendered, counted once for each method that renders them.
    """
    config, parts = layout.config, job.name.split(".")
    match job.rule:
        case "generate_mesh":
            return 1
        case "sample_rays" | "label_rays":
            first, last = layout.shard_range(parts[1], parts[2])
            return (last - first) * config.samplings[parts[1]].points_per_direction
        case "train":
            steps, batch = (layout.training_param(parts[0], k) for k in ("steps", "batch_size"))
            return steps * batch
        case "evaluate":
            first, last = layout.view_range(parts[2])
            evaluation = config.evaluations[parts[0]]
            methods = (
                len(evaluation.networks) + len(evaluation.shadow_maps) + 1
            )  # and the reference
            return (last - first) * methods * config.rendering.width * config.rendering.height
        case "find_depth_biases":
            first, last = layout.held_out_range()
            evaluation = config.evaluations[parts[0]]
            frames = (last - first) * len(evaluation.view_sets) * len(evaluation.networks)
            return frames * config.rendering.width * config.rendering.height
        case "frame_times":
            size = config.frame_times
            rows = config.tables[parts[0]].rows
            methods = [r for r, s in zip(rows, layout.row_scenes(parts[0])) if s == parts[1]]
            frames = (size.repeats + size.warm_up) * len(methods)
            return frames * size.width * size.height
    raise ValueError(job.rule)


def _likeness(layout: Layout, job: Job) -> list[tuple]:
    """Keys that two jobs share if they are alike, from almost the same to the same rule."""
    keys = [(job.rule,)]
    if job.rule == "train":
        experiment = layout.config.experiments[job.name]
        encoding = layout.network_settings(job.name)["encoding"]
        keys += [(job.rule, encoding), (job.rule, encoding, experiment.network)]
    else:
        # Without the numbers of shards and batches.
        keys.append((job.rule, *[part for part in job.name.split(".") if not part.isdigit()]))
    return keys[::-1]


def expected_seconds(
    jobs: Sequence[Job], layout: Layout, measured: Mapping[Job, float], measured_layout: Layout
) -> dict[Job, float]:
    """Seconds of jobs at the rate that the most alike of the measured jobs had.

    A training is most like those of the same network, then of the same encoding; another job is
    most like those with the same names, of other shards and batches; and last, each job is like
    all of its rule.

    Args:
        layout: of the run that the jobs belong to; `measured_layout`: of the measured run.

    Returns:
        The seconds, of the jobs of whose rule any was measured.
    """
    sums: dict[tuple, list[float]] = {}
    for job, seconds in measured.items():
        if job.rule in UNITS:
            work = work_of(measured_layout, job)
            for key in _likeness(measured_layout, job):
                total = sums.setdefault(key, [0.0, 0.0])
                total[0] += seconds
                total[1] += work
    found = {}
    for job in jobs:
        if job.rule in UNITS:
            key = next((key for key in _likeness(layout, job) if key in sums), None)
            if key is not None:
                seconds, work = sums[key]
                found[job] = work_of(layout, job) * seconds / work
    return found


def submissions(
    counts: Mapping[str, int], groups: Mapping[str, str], components: Mapping[str, int]
) -> dict[str, int]:
    """Jobs of Slurm's: by rule, or by group for rules that are submitted in groups.

    Those that run where Snakemake runs are none.

    Args:
        counts: jobs by rule.
        groups: group by rule; `components`: parts of a group that make one job of Slurm's. A
            group has as many parts as its most frequent rule has jobs.
    """
    parts: dict[str, int] = {}
    for rule, count in counts.items():
        if rule in LOCAL:
            continue
        name = groups.get(rule, rule)
        parts[name] = max(parts.get(name, 0), count)
    return {name: math.ceil(count / components.get(name, 1)) for name, count in parts.items()}


def plan_report(
    jobs: Sequence[Job],
    layout: Layout,
    measured: Mapping[Job, float],
    measured_layout: Layout,
    *,
    groups: Mapping[str, str],
    components: Mapping[str, int],
    nodes: Sequence[int],
    cores: int,
) -> str:
    """Tables of jobs, of hours on nodes and of storage, as Markdown.

    Core-hours are those of the measured jobs on their own number of cores; hours on nodes are
    their sum spread over all cores, or the longest job, if that is more.

    Args:
        cores: of a node.
    """
    seconds = expected_seconds(jobs, layout, measured, measured_layout)
    measured_cores = measured_layout.config.compute.threads
    threads = layout.config.compute.threads
    counts = pd.Series([job.rule for job in jobs]).value_counts(sort=False).to_dict()
    sent = submissions(counts, groups, components)

    rows, total, longest = [], 0.0, 0.0
    spent = dict.fromkeys(counts, 0.0)
    for job, value in seconds.items():
        spent[job.rule] += value
    for rule in sorted(counts, key=lambda rule: (-spent[rule], -counts[rule])):
        of_rule = [job for job in jobs if job.rule == rule and job in seconds]
        used, asked = (measured_cores, threads) if rule in MANY_CORES else (1, 1)
        each = [seconds[job] * used / 3600 for job in of_rule]
        group = "local" if rule in LOCAL else groups.get(rule, "")
        row = [rule, counts[rule], group, asked, "", "", ""]
        if of_rule:
            work = sum(work_of(layout, job) for job in of_rule)
            row[4:] = [f"{work:.3g} {UNITS[rule]}", _readable(sum(each)), _readable(max(each))]
            total += sum(each)
            longest = max(longest, max(each) / asked)
        rows.append(row)
    header = ["rule", "jobs", "group", "cores", "work", "core-hours", "largest job, core-hours"]
    tables = [tabulate(rows, header, tablefmt="pipe", disable_numparse=True)]

    sets = {tuple(job.name.split(".")[:2]) for job in jobs if job.rule == "label_rays"}
    rays = sum(
        settings.directions * settings.points_per_direction
        for settings in (layout.config.samplings[sampling] for _, sampling in sets)
    )
    tables.append(
        f"{len(jobs):,} jobs, {sum(sent.values()):,} of Slurm's; {total:,.0f} core-hours; "
        f"the rays take {rays * RAY_BYTES / 1e9:,.3g} GB."
    )
    hours = [(n, _readable(max(total / (n * cores), longest))) for n in nodes]
    header = [f"nodes of {cores} cores", "hours"]
    tables.append(tabulate(hours, header, tablefmt="pipe", disable_numparse=True))
    return "\n\n".join(tables) + "\n"


def _readable(number: float) -> str:
    return f"{number:,.0f}" if number >= 100 else f"{number:.3g}"
