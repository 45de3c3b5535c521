"""Shorthands, nulls, duplicates and the files that a configuration names."""

import copy
import re

import pytest
from checkout import ROOT
from shipped import DEFAULT, shipped

from neural_shadows.config.reading import check_files, read_config, read_sections
from neural_shadows.errors import InputError
from neural_shadows.sections.scenes import DownloadedMesh, MeshFile, Wyrm


@pytest.mark.parametrize(
    ("shorthand", "mesh"),
    [
        ("stanford", DownloadedMesh(download="stanford_dragon")),
        ("../meshes/my.dragon.ply.gz", MeshFile(path="../meshes/my.dragon.ply.gz")),
        ("wyrm", Wyrm(generate="wyrm", cells=64)),  # what the scene has keeps its resolution
    ],
)
def test_dragon_shorthand(message, shorthand, mesh):
    given = shipped("smoke", dragon=shorthand)
    before = copy.deepcopy(given)
    assert read_config(given).scenes["dragon"].mesh == mesh
    assert given == before  # what Snakemake holds is not changed
    assert "is empty. Allowed: wyrm" in message({**given, "dragon": ""})
    del given["scenes"]["dragon"]
    assert "no scene named `dragon`" in message(given)


def test_null_drops_a_key(message, values):
    """Snakemake merges sections: an overlay's `path` comes beside the default's `generate`."""
    values["scenes"]["dragon"]["mesh"] |= {"path": "x.ply", "generate": None}
    values["tables"]["ablations"] = None
    config = read_config(values)
    assert config.scenes["dragon"].mesh == MeshFile(path="x.ply")
    assert "ablations" not in config.tables
    # The message names the referring key.
    assert "tables.table_4_3.figures.1: 'figure_4_5'" in message("figures.figure_4_5", None)


def test_a_star_drops_what_no_file_from_its_own_on_names(tmp_path, values):
    """What the command line adds stays, and other sections stay whole."""
    texts = [
        "tables: {a: {}, b: {}, c: {}}",
        'tables: {"*": null, b: {}, d: {}}',
        "tables: {c: {}}",
    ]
    files = [tmp_path / f"{number}.yaml" for number in range(3)]
    for path, text in zip(files, texts):
        path.write_text(text)
    table = {"title": "Maps", "scene": "dragon", "rows": ["shadow_map_64"]}
    kept = ("b", "c", "d", "e")
    figures = {"figure_3_2": values["figures"]["figure_3_2"]}
    values |= {"tables": {"*": None} | dict.fromkeys(["a", *kept], table), "figures": figures}
    values["claims"] = {}
    config = read_config(values, files)
    assert [*config.tables] == [*kept] and [*config.figures] == [*figures]


def test_mesh_files(values, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name in ("there.fbx", "there.OBJ.gz"):
        (tmp_path / name).touch()
    check_files(read_config({**values, "dragon": "there.OBJ.gz"}))
    for path, words in (
        ("stanfrod", "'stanfrod' (did you mean 'stanford'?) is not among wyrm, stanford, and"),
        ("none.ply", "= 'none.ply': no such file"),
        ("there.fbx", "mesh there.fbx: unknown suffix. Give one of"),
    ):
        with pytest.raises(InputError, match=re.escape(words)):
            check_files(read_config({**values, "dragon": path}))


def test_a_link_to_nothing(values, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "results").symlink_to("gone")
    with pytest.raises(InputError, match="results: is a link to gone, which does not exist"):
        check_files(read_config(values))


def test_what_yaml_lets_pass(tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_text("one:\n  a: 1\ntwo:\n  a: 1\n")
    read_sections(path)
    for text, words in (
        ("one:\n  a: 1\ntwo:\n  a: 1\n  a: 2\n", r"mine\.yaml, line 5: 'a' is defined twice"),
        ("- 3", "has no sections"),
    ):
        path.write_text(text)
        with pytest.raises(InputError, match=words):
            read_sections(path)


def test_a_message_names_the_file_and_line_of_its_key(tmp_path, values):
    first, overlay = tmp_path / "first.yaml", tmp_path / "mine.yaml"
    first.write_text("seed: 3\nscenes:\n  dragon: {up: y}\n")
    overlay.write_text("\nscenes:\n  dragon:\n    up: y\n    upp: z\nmine: 1\n")
    values["scenes"]["dragon"] |= {"up": "y", "upp": "z"}

    def said():
        with pytest.raises(InputError) as caught:
            read_config(values, [first, overlay])
        return str(caught.value)

    assert said().endswith("mine.yaml, line 5]")
    del values["scenes"]["dragon"]["upp"]
    values["mine"] = 1
    assert said().endswith("mine.yaml, line 6]")
    del values["mine"]
    values["seed"] = "many"  # by the command line: no file has this value
    assert said().startswith("config: seed = 'many': ") and "first.yaml" not in said()
    values["seed"] = 3
    values["scenes"]["dragon"]["light"] = 5  # of no file: the last that has the scene
    assert said().endswith("mine.yaml, line 3]")
    overlay.write_text("\nscenes:\n  dragon:\n    up: z\n")
    values["scenes"]["dragon"] |= {"light": {"kind": "sphere"}, "up": 5}  # of the command line
    assert "scenes.dragon.up = 5: " in said() and "mine.yaml" not in said()


def test_a_missing_files_message_names_where_it_is_configured(tmp_path, values):
    overlay = tmp_path / "mine.yaml"
    overlay.write_text("scenes:\n  dragon:\n    mesh:\n      path: gone.ply\n")
    values["scenes"]["dragon"]["mesh"] = {"path": "gone.ply"}
    with pytest.raises(InputError, match=r"mesh.path = 'gone.ply': no such .*mine.yaml, line 4\]$"):
        check_files(read_config(values, [overlay]), [overlay], values)


def test_only_one_files_reports_are_made(values):
    """Of `only`; all that they are made of stays."""
    files = [ROOT / "config" / f"{name}.yaml" for name in DEFAULT]
    whole = read_config(values, files)
    hu = read_config(values | {"only": "hu_2025"}, files)
    assert hu.tables.keys() == {name for name in whole.tables if name.startswith("kpnsm_")}
    assert hu.figures.keys() == {name for name in whole.figures if name.startswith("figure_kpnsm_")}
    assert "kpnsm_leaks_less" in hu.claims and "msm_leaks" not in hu.claims and not hu.viewers
    assert hu.experiments == whole.experiments and hu.scenes == whole.scenes
    both = read_config(values | {"only": ["hu_2025", "soft_shadows"]}, files)
    assert {*hu.tables, "soft_sun"} < both.tables.keys() and "msm_leaks" in both.claims
    with pytest.raises(InputError, match="only: .hu. is not among spanhoff_2026"):
        read_config(values | {"only": "hu"}, files)
    reporting = [
        name for name in DEFAULT if "tables" in read_sections(ROOT / f"config/{name}.yaml")
    ]
    for name in reporting:  # each is valid alone, and all together are the whole
        read_config(values | {"only": name}, files)
    assert read_config(values | {"only": reporting}, files).claims == whole.claims
    for wrong in (1, True, [1], [None]):
        with pytest.raises(InputError, match="only = .* give one of spanhoff_2026"):
            read_config(values | {"only": wrong}, files)


def test_two_files_of_one_name_are_two(tmp_path, values):
    """An overlay may have the name of a default file, which it does not replace."""
    overlay = tmp_path / "soft_shadows.yaml"
    overlay.write_text(
        'tables: {"*": null, soft_sun: {}}\nfigures: {"*": null}\nclaims: {"*": null}'
    )
    files = [*(ROOT / "config" / f"{name}.yaml" for name in DEFAULT), overlay]
    for section in ("tables", "figures", "claims"):
        values[section] |= {"*": None}
    config = read_config(values, files)
    assert [*config.tables] == ["soft_sun"] and not config.figures
