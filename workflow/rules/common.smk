"""The checked configuration and the names that the rules share."""

import hashlib
import inspect
import os
import sys
from pathlib import Path

from snakemake.exceptions import WorkflowError

# The package of this checkout, for the rules and for the stages that they start; of the checkout
# that the file lies in, for as a module another workflow's Snakefile is the main one.
WORKFLOW = Path(workflow.current_basedir.get_path_or_uri(secret_free=True)).parent
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

# glibc hands arrays back to the system and asks for them again, which clears their pages: of 20 CPU s
# of `evaluate_soft` 3.2 went there. It shall keep up to 256 MiB, and take those below 32 MiB from it.
os.environ.setdefault("MALLOC_MMAP_THRESHOLD_", str(32 << 20))
os.environ.setdefault("MALLOC_TRIM_THRESHOLD_", str(256 << 20))

from neural_shadows.config.reading import check_duplicates, check_files, read_config
from neural_shadows.config.resolved import resolved
from neural_shadows.config.targets import check_targets
from neural_shadows.errors import InputError
from neural_shadows.evaluation.method_names import REFERENCES, hard_modules
from neural_shadows.evaluation.soft_registry import method_module
from neural_shadows.layout import (
    frame_sets,
    kinds,
    parts,
    screen_networks,
    soft_methods,
)
from neural_shadows.layout import tables, viewers
from neural_shadows.layout.layout import Layout
from neural_shadows.networks.kind_module import form_module, kind_module
from neural_shadows.reports.claims import inputs as claims
from neural_shadows.reports.page import targets
from neural_shadows.running.module_graph import digest, modules_of
from neural_shadows.scenes.generators.registry import generator_module
from neural_shadows.training.checkpoints import remove_finished

try:
    check_duplicates(workflow.configfiles)
    CONFIG = read_config(config)
    check_files(CONFIG)
    check_targets(sys.argv[1:], CONFIG, WORKFLOW.parent / "config")
except InputError as error:
    raise WorkflowError(str(error))

SETTINGS = resolved(CONFIG)
LAYOUT = Layout(SETTINGS, os.path.relpath(WORKFLOW.parent))
PATHS = LAYOUT.paths
COMPUTE = SETTINGS["compute"]
ENVIRONMENT = "../../envs/environment.yaml"
TEMPLATE = [
    LAYOUT.source(f"workflow/report/page/{name}")
    for name in ("template.html", "style.css", "reading.js", "script.js")
]
VIEWER = [
    LAYOUT.source(os.path.relpath(path, WORKFLOW.parent))
    for path in sorted((WORKFLOW / "report/viewer").glob("**/*.*"))
]
STAGES = WORKFLOW / "neural_shadows"

# What a job that computes networks reserves; with `device: auto` a GPU is used, not reserved.
GPUS = int(COMPUTE["device"] == "cuda")


wildcard_constraints:
    scene="[a-z][a-z0-9_]*",
    sampling="[a-z][a-z0-9_]*",
    experiment="[a-z][a-z0-9_]*",
    method="[a-z][a-z0-9_]*",
    network="[a-z][a-z0-9_]*",
    shard="[0-9]+",
    batch=f"[0-9]+|{parts.HELD_OUT}",
    frame_set="[a-z][a-z0-9_]*",
    part="[a-z]+_[0-9]+",
    # Names that no entry of the configuration has are refused by what looks them up.
    table=r"(?!claims\b)[a-z][a-z0-9_]*",
    figure="figure_[a-z0-9_]+",
    viewer="viewer(_[a-z0-9_]+)?",


def setting(path):
    """A param: what stands at a path of the configuration, whose names may be wildcards.

    Snakemake's own `lookup` walks all settings for each: 17 of 24 s in which everything was planned.
    """
    keys = path.split("/")

    def answer(wildcards):
        found = SETTINGS
        for key in keys:
            found = found[key.format(**wildcards)]
        return found

    return answer


def of(function):
    """An input or a param: what a function of the layout answers for the wildcards it names."""
    needed = [*inspect.signature(function).parameters]

    def answer(wildcards):
        given = {"layout": LAYOUT, **dict(wildcards.items())}
        if unknown := [name for name in needed if name not in given]:
            raise WorkflowError(
                f"{function.__name__}: {unknown[0]!r} is no wildcard of the rule; name one of "
                f"{', '.join(given)}"
            )
        return function(**{name: given[name] for name in needed})

    return answer


def code(stage, encodings=(), generators=(), methods=(), forms=(), modules=()):
    """A param: what the package's modules hold that the result of a stage depends on, as a digest.

    A network's module is imported by its kind's name, of whole frames by its form's, that of a scene by
    its generator's, that of a method for soft shadows by its key, so that they are among them only for
    the jobs that use such a network, such a scene, or such a method; other `modules` likewise.

    As inputs the modules would be compared by their content as well, and looked at by the scheduler
    before each job: a hundred of them and more for each that is ready.
    """
    sources = [
        STAGES / f"{stage}.py",
        *map(kind_module, encodings),
        *map(form_module, forms),
    ]
    sources += [
        *map(generator_module, generators),
        *map(method_module, methods),
        *modules,
    ]
    return digest({module for source in sources for module in modules_of(source)})


def usual(mem_mb, minutes):
    """Memory and minutes of a job: as much again for each attempt after a failed one."""
    return {
        "mem_mb": lambda wildcards, attempt: mem_mb * attempt,
        "runtime": lambda wildcards, attempt: minutes * attempt,
    }
