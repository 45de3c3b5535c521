"""A manifest names what a run is made of; its crate says the same to archives."""

import json
import os
from importlib.metadata import version

import pytest
from checkout import ROOT
from report_samples import MACHINE, RUN, write_record
from rocrate.rocrate import ROCrate

from neural_shadows.files.whole_files import sha256_of
from neural_shadows.reports.data import run_command
from neural_shadows.reports.runs import manifest
from neural_shadows.reports.runs.manifest import jobs_of, time_of, write_manifest
from neural_shadows.running.origin import CHECKOUT, commit_of
from neural_shadows.running.provenance import log_line, read_log_line

NOON = 1_780_000_000.0
MESH = {"name": "wyrm", "faces": 10, "sha256": "ab", "watertight": True}


def write_benchmark(folder, name, end, seconds):
    path = folder / f"{name}.tsv"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f"s\th:m:s\n{seconds}\t0:01:00\n")
    os.utime(path, (end, end))


def write_log(folder, name, commit, machine=MACHINE):
    path = folder / f"{name}.log"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(log_line({"commit": commit, "code": "0f", "machine": machine}) + "\nmore\n")


@pytest.fixture
def written(tmp_path, monkeypatch):
    """A manifest of a table, a scene's picture and a table on request."""
    monkeypatch.setenv(run_command.VARIABLE, "snakemake --config dragon=/home/reader/dragon.ply")
    reports = tmp_path / "reports"
    (reports / "scenes").mkdir(parents=True)
    paths = [reports / name for name in ("table.csv", "scenes/dragon.png", "stored.csv")]
    for path in paths:
        path.write_text(path.name)
    mesh = write_record(tmp_path / "scenes" / "dragon" / "mesh.json", MESH)
    write_benchmark(tmp_path / "benchmarks", "train/dragon", NOON, 100)
    write_log(tmp_path / "logs", "train/dragon", "ab12")
    write_manifest(
        manifest_json=reports / "manifest.json",
        crate_json=reports / "ro-crate-metadata.json",
        reports=paths[:2],
        meshes=[mesh],
        on_request={str(paths[2]): NOON},
        run=RUN,
        configuration="cd",
        logs=tmp_path / "logs",
        benchmarks=tmp_path / "benchmarks",
    )
    return reports


def test_a_manifest(written):
    record = json.loads((written / "manifest.json").read_text())
    assert record["command"] == "snakemake --config dragon=dragon.ply"
    assert (record["scale"], record["seed"]) == (RUN["scale"], RUN["seed"])
    assert record["commit"] == commit_of(CHECKOUT)
    assert record["lock"] == sha256_of(ROOT / "envs" / "hashes.txt")
    assert record["meshes"] == {"dragon": {"name": "wyrm", "faces": 10, "sha256": "ab"}}
    assert record["jobs"] == {"commits": {"ab12": 1}, "machines": {"a CPU, 2 cores": 1}}
    assert record["stages"] == {"train": {"jobs": 1, "seconds": 100.0}}
    assert record["files"].keys() == {"scenes/dragon.png", "stored.csv", "table.csv"}
    for name, file in record["files"].items():
        assert file == {"bytes": len(name.split("/")[-1]), "sha256": sha256_of(written / name)}


def test_a_crate_has_the_same_files(written):
    """Read by the library that archives use."""
    record = json.loads((written / "manifest.json").read_text())
    crate = ROCrate(written)
    files = {entity.id: entity["sha256"] for entity in crate.data_entities}
    assert files == {name: file["sha256"] for name, file in record["files"].items()}
    (action,) = (one for one in crate.contextual_entities if one.type == "CreateAction")
    assert action["name"] == record["command"] and len(action["result"]) == len(files)
    assert action["instrument"]["version"] == record["commit"]
    assert action["endTime"] == record["time"]["last_end"]


def test_packages_that_are_not_the_lock_s(tmp_path, monkeypatch):
    monkeypatch.setattr(manifest, "LOCK", tmp_path / "lock.txt")
    numpy = version("numpy")  # has two pins, of two Pythons
    pins = [("numpy", numpy), ("numpy", "0.1"), ("pandas", "0.1"), ("no-such-package", "1.0")]
    lines = [f"{name}=={pin} ; python_version < '3.12'\n    # via x" for name, pin in pins]
    (tmp_path / "lock.txt").write_text("# a comment\n-e .\n" + "\n".join(lines))
    assert manifest.unlike_lock() == {"pandas": version("pandas")}


def test_time_of_jobs_side_by_side_and_after_a_pause(tmp_path):
    """Two that overlap by 40 s, one within another, and one a day later."""
    for name, end, seconds in (
        *(("a/1", NOON, 100), ("a/2", NOON + 60, 100), ("b/3", NOON - 20, 10)),
        ("b/4", NOON + 86_400, 50),
    ):
        write_benchmark(tmp_path, name, end, seconds)
    time = time_of(tmp_path.glob("*/*.tsv"))
    assert time["busy_seconds"] == 160 + 50
    assert time["first_start"] == "2026-05-28T20:25:00+00:00"
    assert time["last_end"] == "2026-05-29T20:26:40+00:00"
    assert time_of([]) == {}


def test_jobs_of_two_commits_and_machines(tmp_path):
    write_log(tmp_path, "train/a", "ab12")
    write_log(tmp_path, "train/b", "ab12 with uncommitted changes", {**MACHINE, "gpu": "A GPU"})
    write_log(tmp_path, "evaluate/c", "ab12")
    (tmp_path / "evaluate" / "d.log").write_text("")  # killed before its first line
    assert jobs_of(sorted(tmp_path.glob("*/*.log"))) == {
        "commits": {"ab12": 2, "ab12 with uncommitted changes": 1},
        "machines": {"a CPU, 2 cores": 2, "a CPU, 2 cores, A GPU": 1},
    }


def test_lines_of_logs_are_read_as_they_are_written():
    origin = {"commit": "not a git checkout", "machine": MACHINE}
    assert read_log_line(log_line({**origin, "code": None})) == origin
    assert read_log_line("train: 27 % of 6.14M samples") is None


REFERENCE = ROOT / "reports/reference"


def test_files_of_reference_runs_are_those_of_their_manifests():
    for path in REFERENCE.glob("**/manifest.json"):
        for name, file in json.loads(path.read_text())["files"].items():
            if (path.parent / name).exists():  # some are left out
                assert sha256_of(path.parent / name) == file["sha256"], path.parent / name


def test_each_file_of_the_reference_is_in_its_list_of_checksums():
    """To be made again, in that folder: sha256sum $(git ls-files | grep -v -e README.md -e SHA256SUMS) > SHA256SUMS."""
    listed = dict(
        reversed(line.split("  ")) for line in (REFERENCE / "SHA256SUMS").read_text().splitlines()
    )
    files = [path for path in REFERENCE.glob("**/*") if path.is_file()]
    of_runs = {path for path in files if path.name not in ("README.md", "SHA256SUMS")}
    assert {str(path.relative_to(REFERENCE)): sha256_of(path) for path in of_runs} == listed
