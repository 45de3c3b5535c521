"""Stage: minutes of each report on this machine, before it runs."""

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

import pandas as pd

from neural_shadows.reports.costs.plan import EVERYTHING, Job
from neural_shadows.reports.costs.rates import Rates, measure_rates
from neural_shadows.reports.costs.work import REFERENCE, REFERENCE_RATES
from neural_shadows.reports.data.table import Table, write_table
from neural_shadows.running.stage import run_stage

MORE_THREADS = 0.85  # share of the first thread's rate that each more gives a training
LARGEST = 10


def expected_minutes(
    jobs: list[Job],
    targets: Mapping[str, list[int]],
    cores: int,
    scale: str,
    device: str = "auto",
    precision: str = "auto",
) -> Table:
    """Tabulate the minutes of each report, the longest first.

    Args:
        jobs, targets: see `plan`.
        cores: of the run. device, precision: see `measure_rates`.
    """
    rates = measure_rates(device, precision)
    seconds = [seconds_of(job, rates, cores) for job in jobs]
    rows = [_row(name, behind, jobs, seconds, cores) for name, behind in targets.items()]
    table = pd.DataFrame(rows).sort_values("minutes", ascending=False, ignore_index=True)
    shown = {
        "report": table["report"],
        "jobs": table["jobs"].map(str),
        "minutes": table["minutes"].map(_minutes),
        "most of it": table["most_of_it"],
    }
    largest = sorted(targets[EVERYTHING], key=lambda i: -seconds[i])[:LARGEST]
    items = (f"{jobs[i]['rule']} {jobs[i]['name']} {_minutes(seconds[i] / 60)}" for i in largest)
    by_rule = _by_rule(targets[EVERYTHING], jobs, seconds, cores).most_common(LARGEST)
    counts = Counter(jobs[i]["rule"] for i in targets[EVERYTHING])
    rules = (f"{rule} ({counts[rule]} jobs) {_minutes(part)}" for rule, part in by_rule)
    notes = [
        f"Minutes on {cores} cores of this machine, if nothing is there yet. Each job counts in every "
        f"report that needs it, in `{EVERYTHING}` once.",
        f"Minutes of `{EVERYTHING}` by rule: {'; '.join(rules)}.",
        f"Longest jobs of `{EVERYTHING}`, minutes: {'; '.join(items)}.",
        "One thread of this machine: {products:.0f} · 10⁹ multiply-adds a second in products, "
        "{convolutions:.0f} in convolutions ({precision}, {device}); {rays:.1f} · 10⁶ occlusion rays; "
        "{loops:.0f} · 10⁶ exponentials; {start:.1f} s for a process to start.".format(**rates),
        f"Work is counted by the settings, with constants measured on {REFERENCE}. Expect half to "
        "twice these minutes: other work beside the run and downloads are not in them.",
    ]
    title = f"Expected minutes of each report, scale {scale}"
    return Table(table, shown, notes, title=title, text_columns=len(shown))


def seconds_of(job: Job, rates: Rates, cores: int) -> float:
    """Seconds of a job."""
    work = job["work"]
    network = work["products"] / rates["products"] + work["convolutions"] / rates["convolutions"]
    if job["rule"] == "train" and rates["device"] == "cpu":
        network /= 1 + MORE_THREADS * (min(job["threads"], cores) - 1)
    start = work["start"] * rates["start"] / REFERENCE_RATES["start"]
    others = work["seconds"] * REFERENCE_RATES["loops"] / rates["loops"]
    return network + work["rays"] / rates["rays"] + start + others


def _row(
    name: str, behind: Sequence[int], jobs: Sequence[Job], seconds: Sequence[float], cores: int
) -> dict[str, Any]:
    """Columns `report`, `jobs`, `minutes` and `most_of_it`, minutes by rule."""
    by_rule = _by_rule(behind, jobs, seconds, cores)
    # No shorter than its longest job.
    minutes = max(sum(by_rule.values()), max(seconds[i] for i in behind) / 60)
    most = ", ".join(f"{rule} {_minutes(part)}" for rule, part in by_rule.most_common(3))
    return {"report": name, "jobs": len(behind), "minutes": minutes, "most_of_it": most}


def _by_rule(
    behind: Sequence[int], jobs: Sequence[Job], seconds: Sequence[float], cores: int
) -> Counter[str]:
    """Minutes of some jobs on all cores, by rule."""
    minutes: Counter[str] = Counter()
    for i in behind:
        minutes[jobs[i]["rule"]] += seconds[i] * min(jobs[i]["threads"], cores) / cores / 60
    return minutes


def _minutes(minutes: float) -> str:
    return f"{minutes:.0f}" if minutes >= 10 else f"{minutes:.1f}"


if "snakemake" in globals():
    run_stage(snakemake, expected_minutes, write_table)
