"""Tables and figures, each by the module of its kind."""

from importlib import import_module
from typing import Any

from neural_shadows.reports.data.table import whole_table, write_table
from neural_shadows.reports.drawing.style import whole_figure, write_figure
from neural_shadows.running.stage import run_stage


def write_report(job: Any) -> None:
    """Write a job's table or figure.

    By `table` or `draw` of its kind's module, which takes the files and settings that its arguments
    name: `layout.report_inputs`, and the settings of the entry.
    """
    kind = import_module(job.params.module)
    if hasattr(kind, "table"):
        run_stage(job, whole_table(kind.table), write_table)
    else:
        run_stage(job, whole_figure(kind.draw), write_figure)


if "snakemake" in globals():
    write_report(snakemake)
