"""Neural Shadow Ray Queries (Spanhoff 2026) as a reproducible pipeline; see README.md."""

from snakemake.utils import min_version

min_version("9.10")


configfile: "config/config.yaml"


report: "workflow/report/workflow.rst"


include: "workflow/rules/common.smk"
include: "workflow/rules/scenes.smk"
include: "workflow/rules/rays.smk"
include: "workflow/rules/networks.smk"
include: "workflow/rules/evaluation.smk"
include: "workflow/rules/reports.smk"
include: "workflow/rules/costs.smk"


# Before the first job of a run that has any.
onstart:
    check_folders()


# A job that was killed could not say so itself.
onerror:
    tell_of_killed_jobs(Path(LOGS), BEGUN)


# Snakemake has now taken note of all networks.
onsuccess:
    forget_finished(Path(RESULTS) / "networks")


rule all:
    default_target: True
    input:
        LAYOUT.all_reports(),
