"""The checked configuration and the names that the rules share."""

import hashlib
import os
import sys
import time
from pathlib import Path

from snakemake.exceptions import WorkflowError
from snakemake.scheduling.job_scheduler import JobScheduler

# The package of this checkout, for the rules and for the scripts that they start.
WORKFLOW = Path(workflow.basedir) / "workflow"
sys.path.insert(0, str(WORKFLOW))
SEARCH_PATH = "PYTHONPATH"
inherited = [path for path in [os.environ.get(SEARCH_PATH)] if path]
os.environ[SEARCH_PATH] = os.pathsep.join([str(WORKFLOW), *inherited])

# numba keeps compiled kernels by the age of their own file: one that calls a kernel of another
# module would stay as it was when that module is edited. Keyed by the package's content it cannot.
package = b"".join(
    path.read_bytes() for path in sorted(WORKFLOW.glob("neural_shadows/**/*.py"))
)
kernels = os.path.abspath(
    f".snakemake/numba/{hashlib.sha256(package).hexdigest()[:16]}"
)
os.environ.update(NUMBA_CACHE_DIR=kernels)

from neural_shadows.layout import layout
from neural_shadows.config.reading import check_duplicates, check_files, read_config
from neural_shadows.errors import InputError
from neural_shadows.running.file_times import check_clock
from neural_shadows.running.folder_checks import check_writable
from neural_shadows.running.killed_jobs import tell_of_killed_jobs
from neural_shadows.networks.kind_module import kind_module
from neural_shadows.running.module_graph import modules_of
from neural_shadows.running.jobs import remember_configuration
from neural_shadows.training.checkpoints import forget_finished
from neural_shadows.running.scheduler_waits import wait_once

try:
    check_duplicates(workflow.configfiles)
    CONFIG = read_config(config)
    check_files(CONFIG)
    LAYOUT = layout.Layout(CONFIG)
    RESULTS = LAYOUT.results
    REPORTS = LAYOUT.reports
    if workflow.is_main_process:
        sources = [WORKFLOW, WORKFLOW.parent / "config"]
        check_clock([RESULTS, REPORTS, *map(os.path.relpath, sources)])
except InputError as error:
    raise WorkflowError(str(error))

wait_once(JobScheduler)

# For the message of a job that fails.
remember_configuration(
    workflow.overwrite_configfiles, workflow.config_settings.config_args
)

BEGUN = time.time()
LOGS = f"{RESULTS}/logs"
BENCHMARKS = f"{RESULTS}/benchmarks"
SCENE = f"{RESULTS}/{layout.SCENE}"
RAYS = f"{RESULTS}/{layout.RAYS}"
NETWORK = f"{RESULTS}/{layout.NETWORK}"
EVALUATION = f"{RESULTS}/{layout.EVALUATION}"
ENVIRONMENT = "../../envs/environment.yaml"

# What a job that computes networks reserves; with `device: auto` a GPU is used, not reserved.
GPUS = int(CONFIG.compute.device == "cuda")


wildcard_constraints:
    scene="[a-z][a-z0-9_]*",
    sampling="[a-z][a-z0-9_]*",
    experiment="[a-z][a-z0-9_]*",
    evaluation="[a-z][a-z0-9_]*",
    view_set="[a-z]+",
    table=layout.one_of(list(CONFIG.tables)),
    over="[a-z_]+",
    value="[0-9]+",
    shard="[0-9]+",
    batch="[0-9]+",


def code(name, experiments=(), encodings=()):
    """The package's modules that the result of a script depends on.

    A network's module is imported by its kind's name, so that it is among them only for the
    jobs that use such a network.
    """
    used = {LAYOUT.network_settings(e)["encoding"] for e in experiments}.union(
        encodings
    )
    kinds = set(map(kind_module, used))
    sources = [WORKFLOW / "scripts" / f"{name}.py", *kinds]
    modules = kinds.union(*map(modules_of, sources))
    return sorted(os.path.relpath(path) for path in modules)


def per_attempt(amount):
    """Memory or minutes of a job: as much again for each attempt after a failed one."""
    return lambda wildcards, attempt: amount * attempt


def check_folders():
    """Find out whether jobs can write where they will."""
    try:
        check_writable([RESULTS, REPORTS])
    except InputError as error:
        raise WorkflowError(str(error))
