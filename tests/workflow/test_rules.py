"""Each rule gives its stage's function the names that it takes; nothing is run for it."""

import contextlib
import inspect
import os
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import MISSING, fields, is_dataclass
from importlib import import_module
from typing import Any
from unittest import mock

import pytest
from checkout import ROOT
from snakemake.api import SnakemakeApi
from snakemake.exceptions import WorkflowError
from snakemake.iocontainers import Wildcards
from snakemake.settings.types import ConfigSettings, OutputSettings, Quietness, ResourceSettings

from neural_shadows.reports.costs import work
from neural_shadows.reports.costs.plan import EVERYTHING, plan
from neural_shadows.reports.data.table import write_table
from neural_shadows.reports.drawing import opengl

EXAMPLES = {"scene": "dragon", "sampling": "poisson_quadtree", "over": "width", "value": "64"}
EXAMPLES |= dict(experiment="dragon_field", method="dragon_field", batch="000", shard="000")
EXAMPLES |= {"viewer": "viewer", "frame_set": "views", "group": "dragon"}
# Of the rules for soft shadows.
SOFT = {"scene": "room_dragon", "frame_set": "frames", "part": "test_000"}
SOFT |= {"method": "pcss", "table": "soft_methods", "group": "all", "measure": "widths.json"}
OF_FRAMES = ("render_frames", "answer_frames", "measure_frames", "fit_fields")
OF_BOTH = ("tune", "evaluate", "time_methods")
SCREEN = {"network": "nsm", "experiment": "nsm", "frame_set": "nsm"}

# Of a function that does not have the rule's name.
FUNCTIONS = {"figure": "draw", "preview_scene": "draw"}
FUNCTIONS |= {"page": "write_page", "viewer": "write_viewer", "manifest": "write_manifest"}
# Rules whose function returns a table, which `write_table` writes.
RETURNED = ("table", "claims", "expected_minutes")


@pytest.fixture(scope="module")
def workflow() -> Iterator[Any]:
    """The rules as Snakemake reads them."""
    with read_rules({}) as workflow:
        yield workflow


@contextlib.contextmanager
def read_rules(config: Mapping[str, Any]) -> Iterator[Any]:
    """The rules with values of `--config`."""
    with (
        # Figures in three dimensions, too; and a started EGL does not suffer the stages' libraries.
        mock.patch.object(opengl, "available", lambda: True),
        mock.patch.dict(os.environ),
        contextlib.chdir(ROOT),
        SnakemakeApi(OutputSettings(quiet={Quietness.ALL})) as api,
    ):
        given = ResourceSettings(cores=1), ConfigSettings(config=config)
        yield api.workflow(*given, snakefile=ROOT / "Snakefile")._workflow


def entries(workflow: Any, rule: Any) -> list[dict[str, str]]:
    """The wildcards to try a rule with: every configured table and figure."""
    settings = workflow.globals["SETTINGS"]
    if rule.name in ("table", "figure"):
        return [{rule.name: name} for name in settings[f"{rule.name}s"]]
    if rule.name == "page":
        return [{"page": page} for page in ("index", "available")]
    if rule.name == "preview_scene":
        return [{"scene": scene} for scene in ("dragon", "room_dragon")]
    if rule.name == "import_frame":
        return []  # no shipped configuration has frames of an engine: see test_engine_frames.py
    if rule.name == "measure_sun_hours":
        return [{"table": "sun_hours", "scene": "city"}]
    if rule.name in OF_FRAMES:
        return [SOFT]
    if rule.name == "restore_weights":
        shipped = workflow.globals["trainings"].restored(workflow.globals["LAYOUT"])
        return [{"experiment": name} for name in shipped]
    if rule.name == "train":
        return [EXAMPLES, SCREEN]
    if "screen" in rule.name or rule.name == "measure_sensitivity":
        return [SCREEN]
    timed = next(name for name, table in settings["tables"].items() if table["kind"] == "networks")
    of_views = {**EXAMPLES, "table": timed}
    if rule.name == "evaluate":
        of_views["group"] = "dragon.000"
    return [of_views, SOFT] if rule.name in OF_BOTH else [of_views]


def required(function: Any) -> set[str]:
    """Arguments without a default, of a bundle those of its fields."""
    names: set[str] = set()
    for name, parameter in inspect.signature(function).parameters.items():
        if is_dataclass(kind := parameter.annotation):
            without = [
                field for field in fields(kind) if field.default is field.default_factory is MISSING
            ]
            names |= {field.name for field in without if field.init}
        elif parameter.default is parameter.empty:
            names.add(name)
    return names


def test_an_argument_that_is_no_wildcard_is_refused(workflow):
    answer = workflow.globals["of"](lambda layout, scnee: scnee)
    with pytest.raises(WorkflowError, match="'scnee' is no wildcard of the rule. .* scene"):
        answer(Wildcards(fromdict={"scene": "dragon"}))


def test_names(workflow):
    rules = [rule for rule in workflow.rules if rule.script is not None]
    tried = [(rule, example) for rule in rules for example in entries(workflow, rule)]
    assert len(tried) > 40
    for rule, example in tried:
        wildcards = Wildcards(fromdict=example)
        params = {
            name: value(wildcards) if callable(value) else value
            for name, value in rule.params.items()
        }
        outputs = {*rule.output.keys()}
        if rule.name in RETURNED:
            assert outputs == inspect.signature(write_table).parameters.keys() - {"table"}
            outputs = set()
        files = {*rule.expand_input(wildcards)[0].keys()} | outputs
        names = files | {*params, *params.get("settings", {})}
        script = str(rule.script).replace("{params.kind}", params.get("kind", ""))
        room = script[script.index("neural_shadows/") : -len(".py")]
        module = import_module(params.get("module", room.replace("/", ".")))
        name = FUNCTIONS.get(rule.name, rule.name)
        function = getattr(module, name, None) or getattr(module, room.rpartition("/")[2])
        signature = inspect.signature(function)
        names |= {"threads", *example} & signature.parameters.keys()
        if rule.name in ("table", "figure"):  # whose writers take what more there is
            assert required(function) - {"heading"} <= names, (rule.name, example)
            continue
        try:
            signature.bind(**dict.fromkeys(names - {"settings", "code", "beside", "kind"}))
        except TypeError as error:
            pytest.fail(f"rule {rule.name} for {example}: {error}")


def test_each_rule_has_an_expected_time(workflow):
    assert {rule.name for rule in workflow.rules} == work.BY_RULE.keys() | work.CONSTANT.keys()


def test_the_plan_has_all_jobs_of_a_report(workflow):
    planned = plan(workflow.globals["LAYOUT"], workflow.rules)
    jobs, of_table = planned["jobs"], planned["targets"]["table_4_3.csv"]
    counts = Counter(jobs[index]["rule"] for index in of_table)
    assert counts == {
        **{"get_mesh": 1, "prepare_mesh": 1, "draw_directions": 1, "sample_rays": 4},
        **{"describe_rays": 1, "train": 2, "render_references": 3, "find_lpips": 1, "tune": 1},
        **{"preview_scene": 1, "evaluate": 18, "figure": 2, "table": 1},
    }
    assert {*of_table} < {*planned["targets"][EVERYTHING]}
    assert len({(job["rule"], job["name"]) for job in jobs}) == len(jobs)
    assert all(sum(job["work"].values()) > 0 for job in jobs)


def test_soft_shadows_alone_take_no_training():
    with read_rules({"only": "soft_shadows"}) as workflow:
        planned = plan(workflow.globals["LAYOUT"], workflow.rules)
    rules = Counter(planned["jobs"][index]["rule"] for index in planned["targets"][EVERYTHING])
    assert rules["table"] == 8 and rules["claims"] == 1 and rules["evaluate"] > 100
    assert rules["restore_weights"] == 4 and "train" not in rules
