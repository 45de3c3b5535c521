"""Shorthands, nulls, duplicates and the files that a configuration names."""

import copy
import re

import pytest

from neural_shadows.config.reading import check_duplicates, check_files, read_config
from neural_shadows.config.scenes import DownloadedMesh, MeshFile, SphereLight, Wyrm
from neural_shadows.errors import InputError


@pytest.mark.parametrize(
    ("shorthand", "mesh"),
    [
        ("wyrm", Wyrm(generate="wyrm")),
        ("stanford", DownloadedMesh(download="stanford_dragon")),
        ("../meshes/my.dragon.ply.gz", MeshFile(path="../meshes/my.dragon.ply.gz")),
    ],
)
def test_dragon_shorthand(values, shorthand, mesh):
    given = {**values, "dragon": shorthand}
    before = copy.deepcopy(given)
    config = read_config(given)
    assert config.scenes["dragon"].mesh == mesh
    assert config.scenes["dragon"].light == read_config(values).scenes["dragon"].light
    assert given == before  # what Snakemake holds is not changed


def test_dragon_shorthand_keeps_what_agrees(shipped):
    smoke = {**shipped("smoke"), "dragon": "wyrm"}
    assert read_config(smoke).scenes["dragon"].mesh == Wyrm(generate="wyrm", cells=64)


@pytest.mark.parametrize(
    ("shorthand", "words"), [("", "is empty; allowed: wyrm"), (None, "is empty"), (3, "string")]
)
def test_dragon_shorthand_mistakes(message, values, shorthand, words):
    assert words in message({**values, "dragon": shorthand})
    del values["scenes"]["dragon"]
    assert "no scene named `dragon`" in message({**values, "dragon": "wyrm"})


def test_null_drops_a_key(changed, values):
    """Snakemake merges sections: an overlay's `path` comes beside the default's `generate`."""
    values["scenes"]["dragon"]["mesh"] |= {"path": "x.ply", "generate": None}
    values["scenes"]["dragon"]["light"] |= {"axis": None}
    values["claims"]["sampling"] = values["tables"]["ablations"] = None
    values["experiments"]["ablation_grid"] = values["figures"]["figure_4_1"] = None
    config = read_config(values)
    assert config.scenes["dragon"].mesh == MeshFile(path="x.ply")
    assert config.scenes["dragon"].light == SphereLight(domain="sphere", min_elevation_deg=20)
    assert "sampling" not in config.claims and "ablations" not in config.tables
    assert "ablation_grid" not in config.experiments and "figure_4_1" not in config.figures


def test_what_a_dropped_entry_was_named_by(message):
    assert "tables.table_4_3.figures: 'figure_4_4'" in message("figures.figure_4_4", None)


@pytest.mark.parametrize(
    ("path", "words"),
    [
        ("stanfrod", "dragon: 'stanfrod' (did you mean 'stanford'?) is not among wyrm, stanford"),
        ("here.ply", "dragon = 'here.ply': no such file"),
        (
            "there.fbx",
            "dragon: mesh there.fbx: the format is not known by this suffix; give one of",
        ),
        ("folder.ply", "dragon = 'folder.ply': no such file"),
    ],
)
def test_mesh_files(values, tmp_path, monkeypatch, path, words):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "folder.ply").mkdir()
    (tmp_path / "there.fbx").touch()
    with pytest.raises(InputError, match=re.escape(words)):
        check_files(read_config({**values, "dragon": path}))
    (tmp_path / "there.OBJ.gz").touch()
    check_files(read_config({**values, "dragon": "there.OBJ.gz"}))
    check_files(read_config(values))  # names none


def test_trunk_must_be_there(changed, tmp_path):
    config = read_config(changed("metrics.lpips.trunk", str(tmp_path / "alex.pth")))
    with pytest.raises(InputError, match=r"metrics.lpips.trunk = .*: no such file"):
        check_files(config)
    (tmp_path / "alex.pth").touch()
    check_files(config)


def test_name_given_twice(tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_text("scale: mine\nexperiments:\n  one: {scene: a}\n  two: {scene: b}\n")
    check_duplicates([path])
    path.write_text("scale: mine\nexperiments:\n  one: {scene: a}\n  one: {scene: b}\n")
    with pytest.raises(InputError, match=r"mine\.yaml, line 4: 'one' is there twice"):
        check_duplicates([path])


@pytest.mark.parametrize(("text", "words"), [("a: [", "YAML"), ("- 3", "holds no sections")])
def test_unreadable_files(tmp_path, text, words):
    (tmp_path / "mine.yaml").write_text(text)
    with pytest.raises(InputError, match=words):
        check_duplicates([tmp_path / "mine.yaml"])
