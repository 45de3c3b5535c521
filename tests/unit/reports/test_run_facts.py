import subprocess
from platform import python_version

from report_samples import RUN
from sample_records import LPIPS, MACHINE, TRAINING

from neural_shadows.reports.run_facts import commit_of, run_facts


def git(folder, *arguments):
    identity = ["-c", "user.name=Test", "-c", "user.email=test@example.org"]
    subprocess.run(["git", *identity, "-C", folder, *arguments], check=True, capture_output=True)


def test_commit_is_named_and_changes_are_reported(tmp_path):
    assert commit_of(tmp_path) == "not a git checkout"
    git(tmp_path, "init", "--quiet")
    (tmp_path / "file").write_text("one")
    git(tmp_path, "add", "file")
    git(tmp_path, "commit", "--quiet", "-m", "first")
    head = next((tmp_path / ".git/refs/heads").iterdir()).read_text().strip()
    assert commit_of(tmp_path) == head
    (tmp_path / "file").write_text("two")
    assert commit_of(tmp_path) == f"{head} with uncommitted changes"


def test_facts(tmp_path):
    for name, seconds in {"train/a": 100.5, "train/b": 80.0, "evaluate/x": 2.25}.items():
        path = tmp_path / "benchmarks" / f"{name}.tsv"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f"s\th:m:s\tmax_rss\n{seconds}\t0:01:00\t90.5\n")
    other = {**TRAINING, "samples": 20_480_000, "machine": {**MACHINE, "gpu": "A GPU"}}
    facts = run_facts(
        run=RUN,
        meshes={"dragon": "wyrm, 10 triangles"},
        records=[TRAINING, TRAINING, other],
        lpips={**LPIPS, "available": True},
        benchmarks=tmp_path / "benchmarks",
        folder=tmp_path,
    )
    assert facts["mesh of dragon"] == "wyrm, 10 triangles"
    assert facts["training"] == "3 networks, 640 or 20,480,000 samples each"
    assert facts["hardware"] == "a CPU, 2 cores; a CPU, 2 cores, A GPU"
    assert facts["LPIPS"] == "network alex"
    assert facts["durations"] == "evaluate 2 s (1 job); train 3 min (2 jobs)"
    assert facts["versions"].startswith(f"Python {python_version()}, snakemake ")


def test_what_is_not_there_is_no_fact(tmp_path):
    nothing = {"meshes": {}, "records": [], "lpips": None, "benchmarks": tmp_path / "none"}
    facts = run_facts(run=RUN, folder=tmp_path, **nothing)
    assert list(facts) == ["scale", "frames", "seed", "versions", "commit", "made on"]
