"""The shipped configuration is valid, and every mistake is told in one line that helps."""

import copy
import json
from pathlib import Path

import pytest
import yaml

from neural_shadows.config.__main__ import json_schema
from neural_shadows.config.reading import check_duplicates, check_files, read_config
from neural_shadows.config.scenes import DownloadedMesh, MeshFile, SphereLight, Wyrm
from neural_shadows.errors import InputError
from neural_shadows.evaluation.costs import STAGES

ROOT = Path(__file__).parents[3]


@pytest.fixture
def values() -> dict:
    return yaml.safe_load((ROOT / "config" / "config.yaml").read_text())


def change(values: dict, key: str, value) -> dict:
    """The values with the one at `key` (`rendering.width`, `rows.0.label`) set."""
    values = copy.deepcopy(values)
    *sections, last = [int(part) if part.isdigit() else part for part in key.split(".")]
    section = values
    for part in sections:
        section = section[part]
    section[last] = value
    return values


def message_of(values) -> str:
    with pytest.raises(InputError) as caught:
        read_config(values)
    message = str(caught.value)
    assert message.startswith("config: ") and "\n" not in message
    return message


def test_shipped_config_is_valid(values):
    config = read_config(values)
    assert config.scale == "desk"
    assert config.networks["thesis"].model_dump() == {
        "encoding": "frequency",
        "frequencies": 10,
        "width": 256,
        "hidden_layers": 8,
    }
    assert config.mesh_name("dragon") == "wyrm"
    maps = [f"shadow_map_{n}" for n in (2048, 1024, 512, 256, 128)]
    assert config.methods(["dragon"]) == [*maps, "dragon"]
    sampling = ["dragon_uniform_quadtree", "dragon_uniform"]
    assert config.methods(["dragon", "dragon_sampling"]) == [*maps, "dragon", *sampling]
    assert config.compute.device == "auto" and config.rendering.reference == "exact"


@pytest.mark.parametrize("path", sorted((ROOT / "config").glob("*.yaml")), ids=lambda p: p.name)
def test_shipped_overlays_are_valid(values, path):
    def merge(base: dict, overlay: dict) -> None:
        """As Snakemake does: sections are merged, all else is replaced."""
        for key, value in overlay.items():
            if isinstance(value, dict) and isinstance(base.get(key), dict):
                merge(base[key], value)
            else:
                base[key] = value

    merge(values, yaml.safe_load(path.read_text()))
    read_config(values)


TABLE = {
    "title": "Mine",
    "evaluations": ["dragon"],
    "published": "4.3",
    "rows": [{"method": "dragon", "label": "Mine"}],
}

# key, value, and what the message must hold: the key, the value, and what is allowed
MISTAKES = [
    ("sceens", {}, ["sceens: unknown key", "scenes, samplings"]),
    ("rendering.widht", 3, ["rendering.widht: unknown key", "width, height"]),
    ("rendering.width", "wide", ["rendering.width = 'wide'", "integer"]),
    ("rendering.width", "600", ["rendering.width = '600'", "integer"]),
    ("rendering.width", 600.5, ["rendering.width = 600.5", "integer"]),
    ("rendering.width", True, ["rendering.width = True", "integer"]),
    ("rendering.width", 3, ["rendering.width = 3", "greater than or equal to 64"]),
    ("rendering.width", None, ["rendering.width = None", "integer"]),
    ("rendering.reference", "map", ["rendering.reference = 'map'", "'exact' or 'shadow_map'"]),
    ("rendering", None, ["rendering: should be a section"]),
    ("seed", -1, ["seed = -1", "greater than or equal to 0"]),
    ("seed", 2**32, ["seed = 4294967296", "less than"]),
    ("scale", "My Desk", ["scale = 'My Desk'", "^[a-z]"]),
    ("dragon", 3, ["dragon = 3", "string"]),
    ("dragon", "", ["dragon = ''", "at least 1"]),
    ("compute", {"device": "gpu"}, ["compute.device = 'gpu'", "'auto', 'cpu' or 'cuda'"]),
    ("compute", {"threads": 0}, ["compute.threads = 0", "greater than or equal to 1"]),
    ("scenes", 3, ["scenes: should be a section", "3"]),
    ("scenes.dragon", [1], ["scenes.dragon: should be a section", "[1]"]),
    ("scenes.My", {"mesh": {"path": "x.ply"}}, ["scenes.My = 'My'", "^[a-z]"]),
    ("scenes.dragon.up", "w", ["scenes.dragon.up = 'w'", "'x', 'y' or 'z'"]),
    ("scenes.dragon.ground", "no", ["scenes.dragon.ground = 'no'", "boolean"]),
    ("scenes.dragon.seed", 0.5, ["scenes.dragon.seed = 0.5", "integer"]),
    ("scenes.dragon.mesh", None, ["scenes.dragon.mesh = None", "{path: FILE}"]),
    ("scenes.dragon.mesh", "wyrm", ["scenes.dragon.mesh = 'wyrm'", "{generate: wyrm,"]),
    ("scenes.dragon.mesh", {"foo": "x"}, ["scenes.dragon.mesh = {'foo': 'x'}", "{path: FILE}"]),
    ("trainings.base.learning_rate", "1e-3", ["'1e-3'", "text to YAML", "1.0e-3"]),
    ("scale", "networks", ["'networks'", "folder"]),
    ("scenes.dragon.mesh.path", "x.ply", ["'path': 'x.ply'", "to null"]),
    ("scenes.dragon.mesh.cels", 3, ["scenes.dragon.mesh.cels: unknown key", "generate, cells"]),
    ("scenes.dragon.mesh.cells", 7, ["scenes.dragon.mesh.cells = 7", "equal to 48"]),
    ("scenes.dragon.mesh.generate", "dog", ["{'generate': 'dog'}", "fence or landscape"]),
    ("scenes.fence.mesh.wires", 1, ["scenes.fence.mesh.wires = 1", "equal to 2"]),
    ("scenes.fence.mesh.cells", 9, ["scenes.fence.mesh.cells: unknown key", "wires, wire_radius"]),
    ("scenes.dragon.light.domain", "disk", ["scenes.dragon.light", "disk", "'single_axis'"]),
    ("scenes.dragon.light.domaine", 3, ["scenes.dragon.light.domaine", "domain, min_elev"]),
    ("scenes.dragon.light.axis", "x", ["scenes.dragon.light.axis: unknown", "min_elevation_deg"]),
    ("scenes.dragon.light.min_elevation_deg", 95, ["min_elevation_deg = 95", "less than 90"]),
    (
        "scenes.dragon.light",
        {"domain": "single_axis", "axis": "y"},
        ["scenes.dragon.light.axis = 'y'", "allowed: x, z"],
    ),
    ("scenes.dragon.light", {"domain": "single_axis"}, ["scenes.dragon.light.axis: ", "missing"]),
    ("samplings.poisson_quadtree.sampler", "grid", ["sampler = 'grid'", "'uniform_quadtree'"]),
    ("samplings.poisson_quadtree.min_quad", 3, ["samplings.poisson", "min_quad = 3", "power of"]),
    ("samplings.poisson_quadtree.min_quad", 256, ["min_quad = 256", "resolution (128)"]),
    ("samplings.poisson_quadtree.shards", 2001, ["shards = 2001", "directions (2000)"]),
    ("samplings.poisson_quadtree.silhouette_resolution", 100, ["= 100", "power of two"]),
    ("networks.256", {"frequencies": 1, "width": 8, "hidden_layers": 1}, ["networks.256 = 256"]),
    ("networks.thesis.bias", True, ["networks.thesis.bias: unknown key", "hidden_layers"]),
    ("trainings.base.learning_rate", "1e-3", ["trainings.base.learning_rate = '1e-3'", "number"]),
    ("trainings.base.learning_rate", 0, ["trainings.base.learning_rate = 0", "greater than 0"]),
    ("trainings.base.learning_rate", float("nan"), ["learning_rate = nan", "finite"]),
    ("trainings.base.batch_size", 1, ["trainings.base.batch_size = 1", "equal to 16"]),
    ("trainings.base.schedule", "linear", ["schedule = 'linear'", "'constant' or 'cosine'"]),
    ("experiments.dragon.scene", "dog", ["experiments.dragon.scene", "'dog'", "allowed: dragon"]),
    (
        "experiments.copy",
        {
            "scene": "dragon",
            "sampling": "poisson_quadtree",
            "network": "thesis",
            "training": "base",
        },
        ["experiments.copy: is the same as experiments.dragon", "train the same network twice"],
    ),
    ("experiments.dragon.network", "big", ["experiments.dragon.network", "'big'", "thesis"]),
    ("evaluations.dragon.scene", "dog", ["evaluations.dragon.scene", "'dog'", "dragon"]),
    ("evaluations.dragon.networks", ["x"], ["evaluations.dragon.networks", "'x'", "dragon"]),
    ("evaluations.dragon.networks", "dragon", ["evaluations.dragon.networks = 'dragon'", "list"]),
    ("evaluations.dragon.networks", ["dragon"] * 2, ["networks = ['dragon', 'dragon']", "once"]),
    ("evaluations.dragon.networks", [], ["evaluations.dragon.networks = []", "at least 1"]),
    ("evaluations.dragon.shadow_maps", [1], ["evaluations.dragon.shadow_maps.0 = 1", "equal to 2"]),
    ("evaluations.dragon.shadow_maps", [64, 64], ["shadow_maps = [64, 64]", "once"]),
    ("evaluations.dragon.view_sets", ["side"], ["view_sets.0 = 'side'", "'surface' or 'centre'"]),
    ("evaluations.dragon.view_sets", ["surface"] * 2, ["view_sets = ['surface'", "once"]),
    ("metrics", {"lpips": {"net": "resnet"}}, ["metrics.lpips.net = 'resnet'", "'squeeze'"]),
    ("networks.thesis.encoding", "wavelet", ["networks.thesis = ", "one of frequency, ray_grid"]),
    ("networks.ray_grid.occupancy", 64, ["networks.ray_grid.occupancy: unknown key", "channels"]),
    ("networks.hash_grid.table_size", 1000, ["table_size = 1000", "power of two"]),
    ("networks.ray_grid.grids", [1], ["networks.ray_grid.grids.0 = 1", "equal to 2"]),
    ("networks.ray_grid.head", "both", ["networks.ray_grid.head = 'both'", "depth_confidence"]),
    ("networks.field_64.resolution", 66, ["networks.field_64", "resolution = 66", "multiple of 4"]),
    ("networks.field_64.surface", "hollow", ["networks.field_64.surface = 'hollow'", "'sheet'"]),
    ("networks.field_64.stored", "int4", ["networks.field_64.stored = 'int4'", "'int8'"]),
    (
        "trainings.base.loss",
        {"light_leak": -1},
        ["trainings.base.loss.light_leak = -1", "equal to 0"],
    ),
    ("samplings.hemisphere.domain", "light ", ["samplings.hemisphere.domain = 'light '"]),
    ("evaluations.dragon.depth_bias", 2, ["evaluations.dragon.depth_bias = 2", "equal to 1"]),
    (
        "evaluations.dragon.depth_bias",
        "best",
        ["evaluations.dragon.depth_bias = 'best'", "held_out"],
    ),
    (
        "experiments.dragon_biased",
        {"scene": "dragon", "sampling": "uniform", "network": "thesis", "training": "low_rate"},
        ["experiments.dragon_biased: ", "does not end in '_biased'"],
    ),
    ("experiments.dragon.seed", -1, ["experiments.dragon.seed = -1", "equal to 0"]),
    ("tables.beyond.rows.0.scene", None, ["tables.beyond.rows: 'ray_traced' needs a `scene`"]),
    (
        "tables.beyond.rows.6.method",
        "dragon_field",
        ["tables.beyond.rows", "'dragon_field'", "dragon_field_biased"],
    ),
    (
        "tables.beyond.rows.7.label",
        "384³ occupancy field",
        ["tables.beyond.rows: dragon has two rows with the label '384³ occupancy field'"],
    ),
    (
        "evaluations.fence_beyond.view_sets",
        ["surface"],
        ["tables.beyond.evaluations: ", "differ in `view_sets`"],
    ),
    ("figures.figure_beyond_dragon.scene", "hill", ["figure_beyond_dragon.scene: 'hill'", "fence"]),
    ("figures.figure_beyond_dragon.table", "table_4_6", ["figure_beyond_dragon.table", "networks"]),
    ("figures.figure_4_4.scene", "dragon", ["figures.figure_4_4.scene", "leave `scene` out"]),
    (
        "figures.figure_beyond_pictures_fence.methods",
        ["ray_traced"],
        ["figure_beyond_pictures_fence.methods: 'ray_traced' has no pictures"],
    ),
    (
        "figures.figure_beyond_slice.experiment",
        "dragon",
        ["figure_beyond_slice.experiment: 'dragon' is a network of frequency"],
    ),
    ("tables.cost.samples", [20000, 20000], ["tables.cost.samples = [20000, 20000]", "must grow"]),
    (
        "tables.cost",
        {"kind": "cost", "title": "x"} | dict.fromkeys(STAGES, []),
        ["tables.cost: needs a size", "samples"],
    ),
    ("figures.figure_cost.table", "beyond", ["'beyond' is a table of networks", "one of cost"]),
    ("tables.Mine", TABLE, ["tables.Mine = 'Mine'", "^[a-z]"]),
    ("tables.index", TABLE, ["tables.index: a report has this name"]),
    ("tables.table_4_3.published", 4.3, ["tables.table_4_3.published = 4.3", "string"]),
    ("tables.table_4_3.published", "5.1", ["tables.table_4_3.published = '5.1'", "4"]),
    ("tables.table_4_3.evaluations", ["dog"], ["table_4_3.evaluations", "'dog'", "dragon"]),
    ("tables.table_4_3.evaluations", [], ["tables.table_4_3.evaluations = []", "at least 1"]),
    (
        "tables.table_4_3.evaluations",
        ["dragon", "fence"],
        ["'dragon' and 'fence' differ in `scene`", "the same"],
    ),
    (
        "tables.table_4_3.evaluations",
        ["dragon", "dragon"],
        ["tables.table_4_3.evaluations: 'dragon' is in more than one", "each method in one"],
    ),
    (
        "tables.table_4_3.rows.1.method",
        "dragon",
        ["tables.table_4_3.rows: ", "each method only once"],
    ),
    ("tables.table_4_3.rows", [], ["tables.table_4_3.rows = []", "at least 1"]),
    (
        "tables.table_4_3.rows.0.method",
        "shadow_map_64",
        ["tables.table_4_3.rows", "'shadow_map_64'", "shadow_map_2048, shadow_map_1024"],
    ),
    ("claims.sampling.kind", "best", ["claims.sampling", "best", "'better', 'more'"]),
    ("claims.sampling.section", "IV", ["claims.sampling.section = 'IV'", "^[1-9]"]),
    ("claims.sampling.evaluations", ["dog"], ["claims.sampling.evaluations", "'dog'", "dragon"]),
    ("claims.sampling.pairs", [["dragon", "fence"]], ["claims.sampling", "'fence'", "dragon_uni"]),
    ("claims.sampling.pairs", [["dragon"]], ["claims.sampling.pairs.0 = ['dragon']", "at least 2"]),
    (
        "claims.sampling.evaluations",
        ["dragon", "dragon_sampling", "dragon"],
        ["claims.sampling: 'dragon' is in more than one", "each method in one"],
    ),
    ("claims.learning_rate.pairs", [["dragon", "x"]], ["claims.learning_rate", "'x'", "fence"]),
    ("claims.slower_than_shadow_maps.at_least", None, ["needs `at_least`, `at_most`, or both"]),
    (
        "claims.slower_than_shadow_maps.table",
        "table_4_3",
        ["claims.slower_than_shadow_maps.table: 'table_4_3'", "allowed: table_4_6"],
    ),
    (
        "claims.slower_than_shadow_maps.pairs",
        [["dragon", "landscape_axis"]],
        ["'dragon' and 'landscape_axis' are timed together in 0 scenes", "of one scene"],
    ),
    (
        "claims.slower_than_shadow_maps.at_most",
        0.5,
        ["claims.slower_than_shadow_maps", "at_least = 1: must be less than at_most (0.5)"],
    ),
    (
        "claims.learning_rate.pairs",
        [["dragon", "dragon"]],
        ["claims.learning_rate.pairs: 'dragon' is compared with itself"],
    ),
    (
        "claims.lower_bound_costs_more.less",
        "false_shadow",
        ["claims.lower_bound_costs_more", "more = 'false_shadow': must be another"],
    ),
    (
        "evaluations.dragon_widths.view_sets",
        ["shadow"],
        [
            "claims.wider_is_better_on_the_dragon.evaluations: 'dragon' and 'dragon_widths'",
            "differ in `view_sets`",
        ],
    ),
    ("claims.lower_bound_costs_more.methods", ["x"], ["claims.lower_bound", "'x'", "dragon"]),
    ("tables.table_4_3.rows.0.mehtod", "x", ["rows.0.mehtod: unknown key", "method, label"]),
]


@pytest.mark.parametrize(("key", "value", "words"), MISTAKES, ids=lambda part: str(part)[:40])
def test_mistakes(values, key, value, words):
    message = message_of(change(values, key, value))
    for word in words:
        assert word in message
    assert "more)" not in message  # one mistake is told as one


@pytest.mark.parametrize("key", ["scale", "seed", "rendering", "tables"])
def test_missing_section(values, key):
    del values[key]
    assert message_of(values) == f"config: {key}: this key is missing"


def test_missing_key(values):
    del values["trainings"]["base"]["steps"]
    assert message_of(values) == "config: trainings.base.steps: this key is missing"


def test_several_mistakes_are_counted(values):
    values = change(change(values, "rendering.width", 3), "rendering.height", 3)
    assert message_of(values).endswith("(and 1 more)")


def test_shadows_need_a_ground(values):
    message = message_of(change(values, "scenes.dragon.ground", False))
    assert "evaluations.dragon.view_sets: 'shadow'" in message
    assert "allowed here: 'surface', 'centre'" in message


def test_networks_of_another_scene(values):
    values = change(values, "evaluations.dragon.scene", "fence")
    message = message_of(values)
    assert "evaluations.dragon.networks: 'dragon'" in message
    assert "the scene 'dragon', not to 'fence'" in message


@pytest.mark.parametrize("name", ["reference", "shadow_map_2048"])
def test_names_of_other_methods_are_taken(values, name):
    values = change(values, f"experiments.{name}", values["experiments"]["dragon"])
    assert f"experiments.{name}: " in message_of(values)


def test_overlay_drops_a_light_key_by_null(values):
    light = {"domain": "sphere", "axis": None, "min_elevation_deg": 30}
    assert read_config(change(values, "scenes.dragon.light", light)).scenes[
        "dragon"
    ].light == SphereLight(domain="sphere", min_elevation_deg=30)


@pytest.mark.parametrize(
    ("shorthand", "mesh", "name"),
    [
        ("wyrm", Wyrm(generate="wyrm"), "wyrm"),
        ("stanford", DownloadedMesh(download="stanford_dragon"), "stanford_dragon"),
        ("../meshes/my.dragon.ply.gz", MeshFile(path="../meshes/my.dragon.ply.gz"), "my.dragon"),
    ],
)
def test_dragon_shorthand(values, shorthand, mesh, name):
    given = {**values, "dragon": shorthand}
    before = copy.deepcopy(given)
    config = read_config(given)
    assert config.scenes["dragon"].mesh == mesh
    assert config.mesh_name("dragon") == name
    assert config.scenes["dragon"].light == read_config(values).scenes["dragon"].light
    assert given == before  # what Snakemake holds is not changed


def test_dragon_shorthand_keeps_what_agrees(values):
    values = change(values, "scenes.dragon.mesh.cells", 64)
    mesh = read_config({**values, "dragon": "wyrm"}).scenes["dragon"].mesh
    assert mesh == Wyrm(generate="wyrm", cells=64)
    values = change(values, "scenes.dragon.mesh", {"path": "x.ply"})
    mesh = read_config({**values, "dragon": "wyrm"}).scenes["dragon"].mesh
    assert mesh == Wyrm(generate="wyrm")


def test_dragon_shorthand_without_a_dragon(values):
    del values["scenes"]["dragon"]
    assert "no scene named `dragon`" in message_of({**values, "dragon": "wyrm"})


def test_overlay_drops_a_mesh_key_by_null(values):
    """Snakemake merges sections: an overlay's `path` comes beside the default's `generate`."""
    values["scenes"]["dragon"]["mesh"] |= {"path": "x.ply", "generate": None, "cells": None}
    assert read_config(values).scenes["dragon"].mesh == MeshFile(path="x.ply")


@pytest.mark.parametrize(
    ("key", "section"),
    [
        ("scenes.dragon.mesh.path", lambda path: ("scenes.dragon.mesh", {"path": path})),
        ("metrics.lpips.trunk", lambda path: ("metrics.lpips", {"trunk": path})),
    ],
)
def test_named_files_must_be_there(values, tmp_path, monkeypatch, key, section):
    monkeypatch.chdir(tmp_path)
    config = read_config(change(values, *section("here/a.ply")))
    with pytest.raises(InputError) as caught:
        check_files(config)
    message = str(caught.value)
    assert message.startswith(f"config: {key} = 'here/a.ply': no such file") and "\n" not in message
    (tmp_path / "here").mkdir()
    with pytest.raises(InputError):  # a folder on the way is no file
        check_files(read_config(change(values, *section("here"))))
    (tmp_path / "here" / "a.ply").touch()
    check_files(config)
    check_files(read_config(values))  # names none


def test_scene_seed(values):
    assert read_config(values).scene_seed("dragon") == 2026
    values = change(values, "scenes.dragon.seed", 0)
    assert read_config(values).scene_seed("dragon") == 0


def test_schema_is_checked_in():
    path = ROOT / "workflow" / "schemas" / "config.schema.json"
    assert path.read_text(encoding="utf-8") == json_schema(), (
        "make it anew: PYTHONPATH=workflow python -m neural_shadows.config "
        "> workflow/schemas/config.schema.json"
    )


def test_every_key_is_described_and_bounded():
    schema = json.loads(json_schema())
    models = {"Config": schema, **schema["$defs"]}
    assert len(models) > 15
    for name, model in models.items():
        assert model["additionalProperties"] is False, name
        assert model["description"] and not model["description"].startswith("Base of"), name
        for key, field in model["properties"].items():
            assert field.get("description"), f"{name}.{key} has no description"
            if field.get("type") in ("integer", "number"):
                assert field.keys() & {"minimum", "exclusiveMinimum"}, f"{name}.{key}: no range"


def test_schema_accepts_the_shipped_config(values):
    """Editors check the YAML against the schema: the two must agree on what is valid."""
    import jsonschema

    jsonschema.validate(values, json.loads(json_schema()))
    with pytest.raises(jsonschema.ValidationError):
        jsonschema.validate({**values, "sceens": {}}, json.loads(json_schema()))


def test_name_given_twice(tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_text("scale: mine\nexperiments:\n  one: {scene: a}\n  two: {scene: b}\n")
    check_duplicates([ROOT / "config" / "config.yaml", path])
    path.write_text("scale: mine\nexperiments:\n  one: {scene: a}\n  one: {scene: b}\n")
    with pytest.raises(InputError, match=r"mine\.yaml, line 4: 'one' is there twice"):
        check_duplicates([ROOT / "config" / "config.yaml", path])
