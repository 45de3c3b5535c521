"""Shorthands, nulls, duplicates and the files that a configuration names."""

import copy
import re

import pytest
from shipped import shipped

from neural_shadows.config.reading import check_duplicates, check_files, read_config
from neural_shadows.config.scenes import DownloadedMesh, MeshFile, SphereLight, Wyrm
from neural_shadows.errors import InputError


@pytest.mark.parametrize(
    ("overlays", "shorthand", "mesh"),
    [
        ([], "stanford", DownloadedMesh(download="stanford_dragon")),
        ([], "../meshes/my.dragon.ply.gz", MeshFile(path="../meshes/my.dragon.ply.gz")),
        # what the scene has already keeps its resolution
        (["smoke"], "wyrm", Wyrm(generate="wyrm", cells=64)),
    ],
)
def test_dragon_shorthand(overlays, shorthand, mesh):
    given = shipped(*overlays, dragon=shorthand)
    before = copy.deepcopy(given)
    config = read_config(given)
    assert config.scenes["dragon"].mesh == mesh
    assert config.scenes["dragon"].light.domain == "sphere"
    assert given == before  # what Snakemake holds is not changed


@pytest.mark.parametrize(
    ("shorthand", "words"), [("", "is empty; allowed: wyrm"), (None, "is empty"), (3, "string")]
)
def test_dragon_shorthand_mistakes(message, values, shorthand, words):
    assert words in message({**values, "dragon": shorthand})
    del values["scenes"]["dragon"]
    assert "no scene named `dragon`" in message({**values, "dragon": "wyrm"})


def test_null_drops_a_key(message, values):
    """Snakemake merges sections: an overlay's `path` comes beside the default's `generate`."""
    values["scenes"]["dragon"]["mesh"] |= {"path": "x.ply", "generate": None}
    values["scenes"]["dragon"]["light"] |= {"axis": None}
    values["claims"]["sampling"] = values["tables"]["ablations"] = None
    config = read_config(values)
    assert config.scenes["dragon"].mesh == MeshFile(path="x.ply")
    assert config.scenes["dragon"].light == SphereLight(domain="sphere", min_elevation_deg=20)
    assert "sampling" not in config.claims and "ablations" not in config.tables
    # What it was named by is then told.
    assert "tables.table_4_3.figures.0: 'figure_4_4'" in message("figures.figure_4_4", None)


@pytest.mark.parametrize(
    ("path", "words"),
    [
        ("stanfrod", "'stanfrod' (did you mean 'stanford'?) is not among wyrm, stanford, and"),
        ("folder.ply", "= 'folder.ply': no such file"),
        ("there.fbx", "mesh there.fbx: the format is not known by this suffix; give one of"),
    ],
)
def test_mesh_files(values, tmp_path, monkeypatch, path, words):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "folder.ply").mkdir()
    for name in ("there.fbx", "there.OBJ.gz"):
        (tmp_path / name).touch()
    with pytest.raises(InputError, match=re.escape(words)):
        check_files(read_config({**values, "dragon": path}))
    check_files(read_config({**values, "dragon": "there.OBJ.gz"}))


def test_trunk_must_be_there(changed):
    config = read_config(changed("metrics.lpips.trunk", "no_such.pth"))
    with pytest.raises(InputError, match=r"metrics.lpips.trunk = 'no_such.pth': no such file"):
        check_files(config)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("one:\n  a: 1\ntwo:\n  a: 1\n  a: 2\n", r"mine\.yaml, line 5: 'a' is there twice"),
        ("a: [", "cannot be read as YAML"),
        ("- 3", "holds no sections"),
    ],
)
def test_files_that_yaml_lets_pass(tmp_path, text, words):
    path = tmp_path / "mine.yaml"
    path.write_text("one:\n  a: 1\ntwo:\n  a: 1\n")
    check_duplicates([path])
    path.write_text(text)
    with pytest.raises(InputError, match=words):
        check_duplicates([path])
