from platform import python_version

from report_samples import LPIPS, MACHINE, RUN, SCENES, TRAINING, write_record

from neural_shadows.reports.page.run_facts import run_facts, run_sentence
from neural_shadows.running.origin import CHECKOUT, commit_of


def test_facts(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # a module of another workflow runs in the folder of that
    for name, seconds in {"train/a": 100.5, "train/b": 80.0, "evaluate/x": 2.25}.items():
        path = tmp_path / "benchmarks" / f"{name}.tsv"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f"s\th:m:s\tmax_rss\n{seconds}\t0:01:00\t90.5\n")
    other = {**TRAINING, "samples": 20_480_000, "machine": {**MACHINE, "gpu": "A GPU"}}
    other["commit"] = "cd34 with uncommitted changes"
    first, second = (
        write_record(tmp_path / f"{record['samples']}.json", record) for record in (TRAINING, other)
    )
    lpips_json = write_record(tmp_path / "lpips.json", LPIPS)
    meshes = {"dragon": "wyrm, 10 triangles"}
    built = write_record(tmp_path / "built.json", {**TRAINING, "training": None, "samples": 0})
    records = [first, first, second, built]
    facts = run_facts(RUN, meshes, records, lpips_json, tmp_path / "benchmarks")
    assert facts["mesh of dragon"] == "wyrm, 10 triangles"
    assert (
        facts["networks"]
        == "3 networks, 640 or 20,480,000 samples each; 1 more built without training"
    )
    assert facts["networks made on"] == "a CPU, 2 cores; a CPU, 2 cores, A GPU"
    # The page may be written by another checkout than the networks.
    assert facts["networks made at"] == "ab12; cd34 with uncommitted changes"
    assert facts["page made at"] == commit_of(CHECKOUT)
    assert facts["LPIPS"] == "network alex"
    assert facts["durations"] == "evaluate 2 s (1 job); train 3 min (2 jobs)"
    said = run_sentence(RUN, SCENES, facts)
    assert said.startswith(
        "3 networks on rays beside shadow maps, on the meshes wyrm and fence (test scale"
    )
    assert said.endswith("; networks made on a CPU, 2 cores and on a CPU, 2 cores, A GPU.")
    assert facts["versions"].startswith(f"Python {python_version()}, snakemake ")
