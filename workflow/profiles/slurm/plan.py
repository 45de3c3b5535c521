"""Print how a configuration maps to nodes: jobs, hours and storage, as Markdown.

    python workflow/profiles/slurm/plan.py --configfile config/thesis.yaml

Hours come from the jobs of a run that was measured: by default the committed one of the default
configuration on a CPU. With your own, of the cluster's own machines (a GPU, say):

    snakemake --workflow-profile workflow/profiles/slurm --configfile config/lab.yaml
    python workflow/profiles/slurm/plan.py --configfile config/thesis.yaml \\
        --measured results/lab/benchmarks --measured-config config/lab.yaml
"""

import argparse
import csv
import subprocess
import sys
from pathlib import Path

import yaml
from snakemake.utils import update_config

ROOT = Path(__file__).parents[3]
sys.path.insert(0, str(ROOT / "workflow"))

from neural_shadows.config.reading import read_config  # noqa: E402
from neural_shadows.errors import InputError  # noqa: E402
from neural_shadows.layout.cluster_plan import Job, plan_report, read_measured  # noqa: E402
from neural_shadows.layout.layout import Layout  # noqa: E402

DEFAULT = ROOT / "config" / "config.yaml"


def layout_of(overlays: list[Path]) -> Layout:
    """The layout of the default configuration with overlays."""
    config = yaml.safe_load(DEFAULT.read_text(encoding="utf-8"))
    for overlay in overlays:
        update_config(config, yaml.safe_load(overlay.read_text(encoding="utf-8")))
    return Layout(read_config(config))


def planned_jobs(layout: Layout, overlays: list[Path]) -> list[Job]:
    """The jobs that make all reports, from Snakemake's own account."""
    command = [sys.executable, "-m", "snakemake", "--summary", "--cores", "1"]
    if overlays:
        command += ["--configfile", *(str(path.resolve()) for path in overlays)]
    said = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    if said.returncode:
        raise InputError(said.stderr.strip())
    lines = said.stdout[said.stdout.index("output_file\t") :].splitlines()
    rows = csv.DictReader(lines, delimiter="\t")
    return list(
        dict.fromkeys(Job.of_output(layout, row["rule"], row["output_file"]) for row in rows)
    )


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--configfile", type=Path, nargs="*", default=[], help="overlays to plan")
    parser.add_argument(
        "--measured",
        type=Path,
        default=ROOT / "reports" / "reference" / "desk" / "jobs.csv",
        help="benchmark files of a finished run, or their CSV",
    )
    parser.add_argument(
        "--measured-config", type=Path, nargs="*", default=[], help="that run's overlays"
    )
    parser.add_argument("--nodes", type=int, nargs="+", default=[1, 2, 4, 8, 16, 32])
    parser.add_argument("--cores", type=int, default=64, help="of a node")
    args = parser.parse_args()
    profile = yaml.safe_load((Path(__file__).parent / "config.yaml").read_text(encoding="utf-8"))
    try:
        layout = layout_of(args.configfile)
        report = plan_report(
            planned_jobs(layout, args.configfile),
            layout,
            read_measured(args.measured),
            layout_of(args.measured_config),
            groups=profile["groups"],
            components=profile["group-components"],
            nodes=args.nodes,
            cores=args.cores,
        )
    except (InputError, OSError) as error:
        sys.exit(f"plan: {error}")
    print(report, end="")


if __name__ == "__main__":
    main()
