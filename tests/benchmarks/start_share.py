"""What share of a run's time its processes take to start.

    python tests/benchmarks/start_share.py [results]

Each job is a process, which first imports what its rule's script imports at its head. This imports each
script three times, and multiplies the median of their processor time by the number of the rule's logs. A
rule's time is that of its benchmarks; one without benchmarks does little but start, and all of it counts as
start. A dry run of the default targets, as Snakemake plans them, is added to both. What functions import
when they are called is not counted, and a benchmark of a machine that did other work is too long.
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
RULE = re.compile(r'^rule (\w+):\n(?:(?: .*)?\n)*? +script:\n +"\.\./([^"]+)\.py"', re.M)
KIND = "{params.kind}"  # one of several scripts
# Of those the one that imports most.
LARGEST = {"preview_scene": "preview", "viewer": "write_soft_viewer", "train": "train_on_frames"}


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


def share_table(results: Path) -> pd.DataFrame:
    """Jobs, seconds of all and of their starts by rule, Snakemake's plan, and the sum of all."""
    if not (results / "logs").is_dir():
        raise SystemExit(f"{results}/logs: no such folder. Run `snakemake` first")
    scripts, rows = modules(), []
    for folder in sorted((results / "logs").iterdir()):
        jobs = len([*folder.glob("*.log")])
        code = f"import sys; sys.path.insert(0, 'workflow'); import {scripts[folder.name]}"
        start = jobs * processor_seconds([sys.executable, "-c", code])
        benchmarks = [*(results / "benchmarks" / folder.name).glob("*.tsv")]
        seconds = sum(pd.read_csv(path, sep="\t")["s"].sum() for path in benchmarks) or start
        rows.append([folder.name, jobs, seconds, start])
    plan = processor_seconds([sys.executable, "-m", "snakemake", "--dry-run", "--quiet"])
    rows.append(["Snakemake", 1, plan, plan])
    table = pd.DataFrame(rows, columns=["rule", "jobs", "seconds", "start"]).set_index("rule")
    table.loc["all"] = table.sum()
    return table.assign(share=table["start"] / table["seconds"]).sort_values("start")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("results", type=Path, nargs="?", default=Path("results"))
    print(share_table(parser.parse_args().results).to_string(float_format="{:,.3g}".format))
