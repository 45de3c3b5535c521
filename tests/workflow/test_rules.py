"""Each rule gives its stage's function the names that it takes; nothing is run for it."""

import os
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest
from checkout import ROOT
from snakemake.api import SnakemakeApi
from snakemake.iocontainers import Wildcards
from snakemake.settings.types import OutputSettings, Quietness, ResourceSettings

from neural_shadows.reports.figures import opengl
from neural_shadows.running.stage import check_names

EXAMPLES = {
    "scene": "dragon",
    "sampling": "poisson_quadtree",
    "experiment": "dragon_field",
    "method": "dragon_field",
    "batch": "000",
    "shard": "000",
    "over": "width",
    "value": "64",
}

# Of a function that does not have the rule's name.
FUNCTIONS = {"table": "write", "figure": "draw", "preview_scene": "draw"}
FUNCTIONS |= {"claims": "write_claims", "page": "write_page", "available": "write_page"}


@pytest.fixture(scope="module")
def workflow(tmp_path_factory) -> Iterator[Any]:
    """The rules as Snakemake reads them."""
    environment, folder = dict(os.environ), Path.cwd()
    # Figures in three dimensions, too; and a started EGL does not suffer the stages' libraries.
    opengl.available, drawn = (lambda: True), opengl.available
    with SnakemakeApi(OutputSettings(quiet={Quietness.ALL})) as api:
        read = api.workflow(ResourceSettings(cores=1), snakefile=ROOT / "Snakefile", workdir=ROOT)
        yield read._workflow
    opengl.available = drawn
    os.chdir(folder)
    os.environ.clear()
    os.environ.update(environment)


def entries(workflow: Any, rule: Any) -> list[dict[str, str]]:
    """The wildcards to try a rule with: every configured table and figure."""
    settings = workflow.globals["SETTINGS"]
    if rule.name in ("table", "figure"):
        return [{rule.name: name} for name in settings[f"{rule.name}s"]]
    timed = next(name for name, table in settings["tables"].items() if table["kind"] == "networks")
    return [{**EXAMPLES, "table": timed}]


def given(rule: Any, wildcards: Wildcards) -> tuple[str, set[str]]:
    """The kind of a rule's script, and the names that it gives."""
    params = {name: _answer(value, wildcards) for name, value in rule.params.items()}
    files = [*rule.expand_input(wildcards)[0].keys(), *rule.output.keys()]
    names = {*files, *params, *params.get("settings", {})}
    return params.get("kind", ""), names - {"settings", "code", "beside", "kind"}


def _answer(value: Any, wildcards: Wildcards) -> Any:
    return value(wildcards) if callable(value) else value


def test_names(workflow):
    tried, wrong = 0, []
    for rule in workflow.rules:
        if rule.script is None:
            continue
        for example in entries(workflow, rule):
            wildcards = Wildcards(fromdict=example)
            kind, names = given(rule, wildcards)
            script = str(rule.script).replace("{params.kind}", kind)
            room = script[script.index("neural_shadows/") : -len(".py")]
            module = import_module(room.replace("/", "."))
            function = getattr(module, FUNCTIONS.get(rule.name, rule.name))
            offered = {"threads", *example} & set(function.__annotations__)
            try:
                check_names(function, names | offered)
            except TypeError as error:
                wrong.append(f"rule {rule.name} for {example}: {error}")
            tried += 1
    assert not wrong, "\n".join(wrong)
    assert tried > 40
