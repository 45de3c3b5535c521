"""The checked configuration and shared names of the rules."""

import functools
import inspect
import os
import shlex
import sys
from pathlib import Path

from snakemake.cli import get_argument_parser
from snakemake.exceptions import WorkflowError

# The package of this file's checkout, for the rules and their stages: as a module, the main Snakefile
# is another workflow's.
WORKFLOW = Path(workflow.current_basedir.get_path_or_uri(secret_free=True)).parent
sys.path.insert(0, str(WORKFLOW))
SEARCH_PATH = "PYTHONPATH"
inherited = [path for path in [os.environ.get(SEARCH_PATH)] if path]
os.environ[SEARCH_PATH] = os.pathsep.join([str(WORKFLOW), *inherited])

# Of this run, also in jobs that Snakemake starts by commands of its own.
os.environ.setdefault(
    "NEURAL_SHADOWS_COMMAND", shlex.join(["snakemake", *sys.argv[1:]])
)

# glibc returns arrays to the system and requests them again, which clears their pages: 3.2 of 20 CPU
# seconds of `evaluate`. Keep up to 256 MiB, and serve arrays below 32 MiB from them.
os.environ.setdefault("MALLOC_MMAP_THRESHOLD_", str(32 << 20))
os.environ.setdefault("MALLOC_TRIM_THRESHOLD_", str(256 << 20))
# torch's tensors of 2 MiB and more in pages as large, where the system gives them: the clearing of small
# pages was a tenth of a network's time for a frame of 2048 × 1024.
os.environ.setdefault("THP_MEM_ALLOC_ENABLE", "1")

from neural_shadows.config.reading import check_files, read_config
from neural_shadows.config.resolved import resolved
from neural_shadows.config.targets import check_targets
from neural_shadows.errors import InputError
from neural_shadows.evaluation.registry import REFERENCES, method_modules, unbiased
from neural_shadows.layout import evaluations, frame_methods, frame_sets, kinds, parts
from neural_shadows.layout import previews, sun_hours, tables, trainings, viewers
from neural_shadows.layout.layout import Layout
from neural_shadows.networks.kind_module import form_module
from neural_shadows.reports import targets
from neural_shadows.reports.claims import inputs as claims
from neural_shadows.reports.costs.plan import plan
from neural_shadows.reports.page import inputs as pages
from neural_shadows.reports.runs import inputs as runs
from neural_shadows.running import kernel_cache
from neural_shadows.running.module_graph import digest, modules_of
from neural_shadows.training.checkpoints import remove_finished

os.environ[kernel_cache.VARIABLE] = str(kernel_cache.kernel_cache(Path(".snakemake")))

try:
    overlays = len(
        workflow.config_settings.configfiles
    )  # they come first, and are merged last
    files = [*workflow.configfiles[overlays:], *workflow.configfiles[:overlays]]
    CONFIG = read_config(config, files)
    check_files(CONFIG, files, config)
    # Not in jobs: a cluster's command line names the rules that a job may run, as `viewer`.
    if workflow.is_main_process:
        arguments, _ = get_argument_parser().parse_known_args(sys.argv[1:])
        check_targets(arguments.targets, CONFIG, WORKFLOW.parent / "config")
except InputError as error:
    raise WorkflowError(str(error))

SETTINGS = resolved(CONFIG)
LAYOUT = Layout(SETTINGS, os.path.relpath(WORKFLOW.parent))
PATHS = LAYOUT.paths
COMPUTE = SETTINGS["compute"]
ENVIRONMENT = "../../envs/environment.yaml"


def files_of(folder, pattern="**/*.*"):
    """Files of a folder of `workflow`, as inputs."""
    paths = sorted((WORKFLOW / folder).glob(pattern))
    return [LAYOUT.source(os.path.relpath(path, WORKFLOW.parent)) for path in paths]


# By the stage that fills them in. That of an area light shares some of the other's.
VIEWERS = {
    "write_viewer": files_of("report/viewer"),
    "write_soft_viewer": [
        *(
            path
            for path in files_of("report/viewer")
            if os.path.basename(path) in viewers.SHARED
        ),
        *files_of("report/soft_viewer"),
    ],
}
STAGES = WORKFLOW / "neural_shadows"

# GPUs of a job that computes networks; with `device: auto` a GPU is used, not reserved.
GPUS = int(COMPUTE["device"] == "cuda")
# Cores of the run. A cluster's may have no number.
CORES = workflow.global_resources["_cores"].value or COMPUTE["timing_cores"]
# Those whose idle ones a training may use: of a cluster's job all of its node would be counted.
SHARED_CORES = 0 if workflow.remote_exec else CORES


wildcard_constraints:
    scene="[a-z][a-z0-9_]*",
    sampling="[a-z][a-z0-9_]*",
    experiment="[a-z][a-z0-9_]*",
    method="[a-z][a-z0-9_]*",
    network="[a-z][a-z0-9_]*",
    shard="[0-9]+",
    batch=f"[0-9]+|{parts.HELD_OUT}",
    frame_set="[a-z][a-z0-9_]*",
    # A scene, SCENE.BATCH or `all`.
    group=rf"[a-z][a-z0-9_]*(\.([0-9]+|{parts.HELD_OUT}))?",
    measure=r"widths\.json|occluders\.npy",
    part="[a-z]+(_[a-z]+)?_[0-9]+",
    # Names without an entry in the configuration are refused by the functions below.
    table=r"(?!(claims|expected_minutes|manifest)\b)[a-z][a-z0-9_]*",
    figure="figure_[a-z0-9_]+",
    viewer="viewer(_[a-z0-9_]+)?",


def with_signature(function):
    """A function that keeps its signature: Snakemake derives it anew for each job."""
    function.__signature__ = inspect.signature(function)
    return function


def setting(path):
    """A param: the setting at a path with wildcards.

    Snakemake's own `lookup` walks all settings for each: 17 of 24 s of planning.
    """
    keys = path.split("/")

    def value_of(wildcards):
        value = SETTINGS
        for key in keys:
            value = value[key.format(**wildcards)]
        return value

    return with_signature(value_of)


def of(function):
    """An input or a param: a layout function of wildcards."""
    names = [*inspect.signature(function).parameters]

    def value_of(wildcards):
        arguments = {"layout": LAYOUT, **dict(wildcards.items())}
        if unknown := [name for name in names if name not in arguments]:
            raise WorkflowError(
                f"{function.__name__}: {unknown[0]!r} is no wildcard of the rule. Name one of "
                f"{', '.join(arguments)}"
            )
        return function(**{name: arguments[name] for name in names})

    return with_signature(value_of)


def code(stage, modules=()):
    """A param: a digest of the modules behind a stage's result.

    Those imported by name, of networks, scenes or methods, are `modules`: only the jobs that use them
    depend on them. As inputs, a hundred modules and more would be checked by the scheduler for each
    ready job.
    """
    return digest_of(frozenset([STAGES / f"{stage}.py", *modules]))


@functools.cache
def digest_of(sources):
    """The digest of some modules and of all that they import."""
    return digest({module for source in sources for module in modules_of(source)})


def usual(mem_mb, minutes):
    """Memory and minutes of a job, in proportion to attempts."""
    return {
        "mem_mb": with_signature(lambda wildcards, attempt: mem_mb * attempt),
        "runtime": with_signature(lambda wildcards, attempt: minutes * attempt),
    }
