import subprocess
from platform import python_version

import pytest

from neural_shadows.reports.run_facts import commit_of, durations, run_facts


def git(folder, *arguments):
    identity = ["-c", "user.name=Test", "-c", "user.email=test@example.org"]
    subprocess.run(["git", *identity, "-C", folder, *arguments], check=True, capture_output=True)


@pytest.fixture
def checkout(tmp_path):
    folder = tmp_path / "checkout"
    folder.mkdir()
    git(folder, "init", "--quiet")
    (folder / "file").write_text("one")
    git(folder, "add", "file")
    git(folder, "commit", "--quiet", "-m", "first")
    return folder


@pytest.fixture
def benchmarks(tmp_path):
    for name, seconds in {"train/a": 100.5, "train/b": 80.0, "evaluate/x": 2.25}.items():
        path = tmp_path / "benchmarks" / f"{name}.tsv"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f"s\th:m:s\tmax_rss\n{seconds}\t0:01:00\t90.5\n")
    return tmp_path / "benchmarks"


def test_commit_is_named_and_changes_are_told(checkout):
    head = (checkout / ".git/refs/heads").iterdir().__next__().read_text().strip()
    assert commit_of(checkout) == head
    (checkout / "file").write_text("two")
    assert commit_of(checkout) == f"{head} with uncommitted changes"


def test_folder_without_git_has_no_commit(tmp_path):
    assert commit_of(tmp_path) == "not a git checkout"


def test_durations_are_summed_by_rule(benchmarks):
    assert durations(benchmarks) == {"train": (2, 180.5), "evaluate": (1, 2.25)}


def test_facts(benchmarks, checkout):
    record = {
        "samples": 20_480_000,
        "machine": {"cpu": "A CPU", "cores": 2, "gpu": None},
    }
    other = {
        "samples": 1_000,
        "machine": {"cpu": "A CPU", "cores": 2, "gpu": "A GPU"},
    }
    facts = dict(
        run_facts(
            scale="desk",
            seed=7,
            frames="24 views",
            meshes={"dragon": "wyrm, 10 triangles"},
            records=[record, record, other],
            lpips={"available": True, "net": "squeeze"},
            benchmarks=benchmarks,
            folder=checkout,
        )
    )
    assert facts["mesh of dragon"] == "wyrm, 10 triangles"
    assert facts["training"] == "3 networks, 1,000 or 20,480,000 samples each"
    assert facts["hardware"] == "A CPU, 2 cores; A CPU, 2 cores, A GPU"
    assert facts["LPIPS"] == "network squeeze"
    assert facts["durations"] == "evaluate 2 s (1 job); train 3 min (2 jobs)"
    assert facts["seed"] == "7"
    assert facts["versions"].startswith(f"Python {python_version()}, snakemake ")
