"""All jobs behind a run's reports, made already or not."""

from collections.abc import Iterable, Mapping
from dataclasses import asdict
from typing import Any, TypedDict

from neural_shadows.layout.layout import Layout
from neural_shadows.reports import targets
from neural_shadows.reports.costs.work import work_of

EVERYTHING = "everything"


class Job(TypedDict):
    """A job."""

    rule: str
    name: str  # its wildcards
    threads: int
    work: dict[str, float]  # see `Work`


class Plan(TypedDict):
    """Jobs, and by target the indices of those behind it."""

    jobs: list[Job]
    targets: dict[str, list[int]]


def plan(layout: Layout, rules: Iterable[Any]) -> Plan:
    """Jobs behind each report, and behind all default ones.

    Args:
        rules: Snakemake's. Its own graph has the jobs of one command that are still to do; so files
            are followed through the rules anew, 1,166 jobs in 0.9 s.
    """
    rules = list(rules)
    makers: dict[str, int | None] = {}  # by file, the index of its job
    indices: dict[tuple[str, ...], int] = {}
    jobs: list[Job] = []
    inputs: list[list[str]] = []

    def maker_of(file: str) -> int | None:
        rule = next((rule for rule in rules if rule.is_producer(file)), None)
        if rule is None:
            return None
        wildcards = rule.get_wildcards(file)
        index = indices.setdefault((rule.name, *wildcards.values()), len(jobs))
        if index == len(jobs):
            jobs.append(_job(layout, rule, wildcards))
            inputs.append(_inputs(rule, wildcards))
        return index

    def behind(files: Iterable[str]) -> list[int]:
        waiting, found = [*files], set()
        while waiting:
            file = waiting.pop()
            if file not in makers:
                makers[file] = maker_of(file)
            if (index := makers[file]) is not None and index not in found:
                found.add(index)
                waiting += inputs[index]
        return sorted(found)

    return {
        "targets": {name: behind(files) for name, files in reports(layout).items()},
        "jobs": jobs,
    }


def reports(layout: Layout) -> dict[str, list[str]]:
    """Files of all default reports, and of each table, viewer, the claims, and figure of no table."""
    settings, report = layout.settings, layout.paths.report
    files = [
        *(f"{name}.csv" for name in settings["tables"]),
        *(f"{name}.png" for name, figure in settings["figures"].items() if "table" not in figure),
        *(f"{name}.html" for name in settings["viewers"]),
        *(["claims.csv"] if settings["claims"] else []),
    ]
    return {EVERYTHING: targets.all_reports(layout)} | {file: [report(file)] for file in files}


def _job(layout: Layout, rule: Any, wildcards: Mapping[str, str]) -> Job:
    return {
        "rule": rule.name,
        "name": ".".join(wildcards.values()),
        "threads": rule.resources["_cores"].value,
        "work": asdict(work_of(layout, rule.name, wildcards)),
    }


def _inputs(rule: Any, wildcards: Mapping[str, str]) -> list[str]:
    from snakemake.iocontainers import Wildcards  # not in a job's process

    files, *_ = rule.expand_input(Wildcards(fromdict=wildcards))
    return [str(file) for file in files]
