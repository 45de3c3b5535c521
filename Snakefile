"""Neural shadows beside classic ones, see README.md."""

from snakemake.utils import min_version

min_version("9.10")


configfile: "config/config.yaml"
configfile: "config/spanhoff_2026.yaml"
configfile: "config/extensions.yaml"
configfile: "config/soft_shadows.yaml"
configfile: "config/datta_2022.yaml"
configfile: "config/hu_2025.yaml"
configfile: "config/layouts.yaml"


report: "workflow/report/workflow.rst"


include: "workflow/rules/common.smk"
include: "workflow/rules/meshes.smk"
include: "workflow/rules/rays.smk"
include: "workflow/rules/networks.smk"
include: "workflow/rules/evaluation.smk"
include: "workflow/rules/frames.smk"
include: "workflow/rules/screen_networks.smk"
include: "workflow/rules/reports.smk"
include: "workflow/rules/viewer.smk"


rule all:
    default_target: True
    input:
        targets.all_reports(LAYOUT),
        PATHS.report("manifest.json"),


onsuccess:
    # Snakemake has recorded all networks by now.
    remove_finished(Path(PATHS.results) / "networks")
    outputs = [path for job in workflow.dag.finished_jobs for path in job.output]
    if words := targets.closing_words(LAYOUT, outputs):
        print(words)
