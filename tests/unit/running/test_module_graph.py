"""A stage's modules are those that it needs: an edited plot must not retrain a network."""

import ast

import pytest

from neural_shadows.networks.kind_module import ENCODINGS, FORMS, form_module, kind_module
from neural_shadows.running import module_graph
from neural_shadows.running.module_graph import PACKAGE, digest, modules_of
from neural_shadows.settings.kinds import kinds

STAGES = [path for path in PACKAGE.rglob("*.py") if "(snakemake, " in path.read_text("utf-8")]
# The modules of `write_report`.
STAGES += [
    path for room in ("tables", "figures") for path in PACKAGE.glob(f"reports/{room}/[a-z]*.py")
]


@pytest.mark.parametrize("stage", STAGES, ids=lambda path: path.stem)
def test_no_stage_depends_on_the_configuration(stage):
    found = modules_of(stage)
    assert stage in found and PACKAGE / "running" / "stage.py" not in found
    assert not {path.parent.name for path in found} & {"config", "layout"}


@pytest.mark.parametrize(
    ("module", "stages"),
    [
        # Figures of a table import its settings.
        (
            "reports/tables/comparison.py",
            {"tables/comparison"}
            | {f"figures/{n}" for n in ("contact_sheet", "errors_3d", "pictures")},
        ),
        ("reports/claims/write_claims.py", {"claims/write_claims"}),
        ("reports/drawing/preview.py", {"drawing/preview"}),
        ("evaluation/evaluate.py", {"evaluation/evaluate"}),
        # Through the methods, which are inputs of their jobs.
        ("shadow_maps/shadow_map.py", set()),
    ],
)
def test_a_module_has_these_stages(module, stages):
    found = {stage for stage in STAGES if PACKAGE / module in modules_of(stage)}
    assert {"/".join(stage.with_suffix("").parts[-2:]) for stage in found} == stages


def test_metrics_are_measured_by_one_stage_and_named_by_reports():
    found = [stage for stage in STAGES if PACKAGE / "metrics/kinds/flip.py" in modules_of(stage)]
    rooms = [stage.relative_to(PACKAGE).parts for stage in found]
    assert {parts for parts in rooms if parts[0] != "reports"} == {("evaluation", "evaluate.py")}
    assert {"comparison.py", "write_claims.py", "page.py"} <= {parts[-1] for parts in rooms}
    of_map = modules_of(PACKAGE / "evaluation/methods/shadow_map.py")
    assert PACKAGE / "shadow_maps/shadow_map.py" in of_map


def test_training_depends_on_what_decides_the_weights():
    found = modules_of(PACKAGE / "training" / "train_on_rays.py")
    names = {path.relative_to(PACKAGE).as_posix()[:-3] for path in found}
    assert {"training/training_run", "networks/weight_file", "rays/ray_set"} <= names
    rooms = {name.split("/")[0] for name in names}
    assert not rooms & {"reports", "metrics", "evaluation", "rendering", "meshes"}
    # A kind of network is an input of the trainings of that kind alone.
    kinds = {name for name in names if name.endswith("_network")}
    assert kinds == {"networks/object_space/shadow_network"}


@pytest.mark.parametrize(
    "module", [*map(kind_module, kinds(ENCODINGS)), *map(form_module, kinds(FORMS))]
)
def test_a_kind_of_network_depends_on_its_own_class_and_on_no_settings(module):
    names = [path.relative_to(PACKAGE).as_posix() for path in modules_of(module)]
    assert [name for name in names if name.endswith(("_network.py", "_unet.py"))]
    assert not [name for name in names if name.startswith(("settings/", ENCODINGS, FORMS))]
    assert "networks/settings" not in {name.rpartition("/")[0] for name in names}


@pytest.mark.parametrize(
    "stage",
    [
        "frames/render_frames",
        "evaluation/tune",
        "evaluation/evaluate",
        "evaluation/time_methods",
        "evaluation/measured_frames",
        "evaluation/frame_metrics",
        "evaluation/time_frames",
    ],
)
def test_soft_shadows_depend_on_no_network_and_no_other_method(stage):
    found = modules_of(PACKAGE / f"{stage}.py")
    names = {path.relative_to(PACKAGE).as_posix()[:-3] for path in found}
    others = {name.split("/")[0] for name in names - {"networks/pretrained_trunk"}}  # LPIPS's
    assert not others & {"training", "networks", "rays", "reports"}
    # Maps of a directional light are the thesis's; a scene or a method is an input of its own jobs.
    assert "shadow_maps/shadow_map" not in names
    kinds = {path.stem for path in found if path.parent.name in ("methods", "generators")}
    assert kinds <= {"registry"}


def test_all_forms_of_import_are_followed(tmp_path):
    script = tmp_path / "script.py"
    script.write_text(
        "import neural_shadows.running.progress\n"
        "from neural_shadows import errors\n"
        "from neural_shadowsx.rays import shards\n"
        "def main():\n"
        "    import numpy, neural_shadows.running.hardware as h\n"
    )
    names = {path.stem for path in modules_of(script)}
    assert names == {"script", "progress", "errors", "hardware"}


def test_a_digest_is_of_names_and_content_and_not_of_where_they_lie(tmp_path, monkeypatch):
    def of(folder, **modules):
        monkeypatch.setattr(module_graph, "PACKAGE", tmp_path / folder)
        paths = [tmp_path / folder / f"{name}.py" for name in modules]
        paths[0].parent.mkdir()
        for path, text in zip(paths, modules.values()):
            path.write_text(text)
        return digest(reversed(paths))

    first = of("first", a="1", b="2")
    assert first == of("again", a="1", b="2")
    assert len({first, of("content", a="1", b="3"), of("name", a="1", c="2")}) == 3


def test_a_digest_is_of_no_comment_and_no_docstring(tmp_path, monkeypatch):
    monkeypatch.setattr(module_graph, "PACKAGE", tmp_path)

    def of(name, text):
        (tmp_path / name).mkdir()
        path = tmp_path / name / "module.py"
        path.write_text(text)
        return module_graph._content(path).split()[1]

    code = 'def f():\n    """{}"""\n    {}\n    return """\n{}\n"""\n'
    first = of("first", code.format("One.", "# one", "x"))
    assert first == of("words", code.format("Two.\n\n    More.\n    ", "# two", "x"))
    assert first != of("text", code.format("One.", "# one", "y"))


def test_what_a_digest_leaves_out_is_not_code():
    """As Python itself reads it: of each module the rest means the same."""
    for path in PACKAGE.rglob("*.py"):
        text = path.read_text("utf-8")
        assert _meaning(module_graph._code(text)) == _meaning(text), path


@pytest.mark.parametrize("text", ['T = (\n    """Dark"""\n)\n', 'T = """C\n# define A 1\n"""\n'])
def test_texts_that_look_like_docstrings_and_comments_are_found(text):
    assert _meaning(module_graph._code(text)) != _meaning(text)


def _meaning(text):
    tree = ast.parse(text)
    for node in ast.walk(tree):
        if isinstance(body := getattr(node, "body", None), list):
            node.body = [statement for statement in body if not _is_text(statement)]
    return ast.dump(tree)


def _is_text(statement):
    value = getattr(statement, "value", None)
    return isinstance(statement, ast.Expr) and isinstance(getattr(value, "value", None), str)


def test_kernels_need_no_report_and_no_kind():
    """Their compiled forms are kept apart by these modules' content: see workflow/rules/common.smk."""
    compiled = [path for path in PACKAGE.rglob("*.py") if b"import njit" in path.read_bytes()]
    found = {module for path in compiled for module in modules_of(path)}
    assert len(compiled) > 30 and not {"reports", "kinds"} & {n for p in found for n in p.parts}
