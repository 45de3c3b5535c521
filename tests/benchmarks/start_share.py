"""What share of a run's processor time its processes take to start.

    python tests/benchmarks/start_share.py [results/benchmarks]

Each job is a process, which first imports what its rule's script imports. This imports each script three
times, multiplies the median by the number of its jobs, and divides by the time of all jobs, from their
benchmarks. A dry run of everything, Snakemake's own start and plan, is added to both.
"""

import argparse
import re
import statistics
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from resource import RUSAGE_CHILDREN, getrusage

import pandas as pd

ROOT = Path(__file__).parents[2]
ROUNDS = 3
KIND = "{params.kind}"  # one of several scripts: the one that imports most
LARGEST = {"preview_scene": "preview", "viewer": "write_soft_viewer", "train": "train_on_frames"}
RULE = re.compile(r'^rule (\w+):\n(?:(?: .*)?\n)*? +script:\n +"\.\./([^"]+)\.py"', re.M)


def modules() -> dict[str, str]:
    """The module of each rule's script."""
    texts = (path.read_text(encoding="utf-8") for path in ROOT.glob("workflow/rules/*.smk"))
    found = {rule: file for text in texts for rule, file in RULE.findall(text)}
    found |= {rule: found[rule].replace(KIND, file) for rule, file in LARGEST.items()}
    return {rule: file.replace("/", ".") for rule, file in found.items()}


def processor_seconds(command: Sequence[str]) -> float:
    """User's and system's time of a command and its children: median of `ROUNDS`."""
    spent = []
    for _ in range(ROUNDS):
        before = getrusage(RUSAGE_CHILDREN)
        subprocess.run(command, check=True, cwd=ROOT, capture_output=True)
        after = getrusage(RUSAGE_CHILDREN)
        spent.append(after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime)
    return statistics.median(spent)


def share_table(benchmarks: Path) -> pd.DataFrame:
    """Jobs, seconds of all and of their starts by rule, Snakemake's plan, and the sum of all."""
    scripts, rows = modules(), []
    for folder in sorted(benchmarks.iterdir()):
        jobs = [pd.read_csv(path, sep="\t")["cpu_time"].sum() for path in folder.glob("*.tsv")]
        code = f"import sys; sys.path.insert(0, 'workflow'); import {scripts[folder.name]}"
        start = processor_seconds([sys.executable, "-c", code])
        rows.append([folder.name, len(jobs), sum(jobs), len(jobs) * start])
    plan = processor_seconds([sys.executable, "-m", "snakemake", "--dry-run", "--quiet"])
    rows.append(["Snakemake", 1, plan, plan])
    table = pd.DataFrame(rows, columns=["rule", "jobs", "cpu_s", "start_s"]).set_index("rule")
    table.loc["all"] = table.sum()
    return table.assign(share=table["start_s"] / table["cpu_s"]).sort_values("start_s")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("benchmarks", type=Path, nargs="?", default=Path("results/benchmarks"))
    print(share_table(parser.parse_args().benchmarks).to_string(float_format="{:,.3g}".format))
