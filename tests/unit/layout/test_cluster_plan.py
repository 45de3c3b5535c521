"""What a run takes on a cluster, computed from another run's jobs."""

import re
from pathlib import Path

import pytest
import yaml

from neural_shadows.config.reading import read_config
from neural_shadows.errors import InputError
from neural_shadows.layout.cluster_plan import (
    LOCAL,
    MANY_CORES,
    Job,
    expected_seconds,
    plan_report,
    read_measured,
    submissions,
    work_of,
)
from neural_shadows.layout.layout import Layout

ROOT = Path(__file__).parents[3]


def layout_of(**changes) -> Layout:
    """The default configuration with some sections changed."""
    config = yaml.safe_load((ROOT / "config" / "config.yaml").read_text())
    for section, values in changes.items():
        if isinstance(values, dict):
            for name, value in values.items():
                old = config.setdefault(section, {}).get(name)
                config[section][name] = old | value if isinstance(old, dict) else value
        else:
            config[section] = values
    return Layout(read_config(config))


@pytest.fixture(scope="module")
def desk() -> Layout:
    return layout_of()


@pytest.fixture(scope="module")
def large() -> Layout:
    return layout_of(
        scale="large",
        compute={"threads": 8},
        samplings={"poisson_quadtree": {"directions": 20_000, "shards": 10}},
        trainings={"base": {"steps": 200_000}},
    )


def test_jobs_are_known_by_their_files(desk, large):
    for layout, below in ((desk, ""), (large, "/large")):
        for rule, output, name in (
            ("evaluate", f"results{below}/evaluations/dragon/shadow.001.csv", "dragon.shadow.001"),
            ("evaluate", f"results{below}/evaluations/dragon/shadow.001.npz", "dragon.shadow.001"),
            ("train", f"results{below}/networks/fence/weights.safetensors", "fence"),
            ("train", f"results{below}/networks/fence/loss.csv", "fence"),
            ("sample_rays", f"results{below}/rays/a/b/origins.002.npy", "a.b.002"),
            ("find_depth_biases", f"results{below}/evaluations/a/depth_biases.json", "a"),
            ("frame_times", f"results{below}/frame_times/table_4_6/a.json", "table_4_6.a"),
            ("table", f"reports{below}/table_4_3.md", "table_4_3"),
        ):
            assert Job.of_output(layout, rule, output) == Job(rule, name)


def test_work(desk):
    shard = work_of(desk, Job("label_rays", "dragon.poisson_quadtree.003"))
    assert shard == 2000 * 5000 / 4
    assert work_of(desk, Job("train", "dragon")) == 20_000 * 1024
    # 12 viewpoints of 600 × 400 by a network, five maps and the reference.
    assert work_of(desk, Job("evaluate", "dragon.shadow.001")) == 12 * 7 * 600 * 400
    with pytest.raises(ValueError, match="claims"):
        work_of(desk, Job("claims", "claims"))


def test_times_scale_with_work(desk, large):
    measured = {
        Job("train", "dragon"): 200.0,
        Job("label_rays", "dragon.poisson_quadtree.000"): 4.0,
        Job("label_rays", "dragon.poisson_quadtree.001"): 6.0,
    }
    jobs = [Job("train", "dragon"), Job("label_rays", "dragon.poisson_quadtree.007")]
    found = expected_seconds(jobs, large, measured, desk)
    # Ten times the steps; a shard of 2000 directions where 1000 took 10 s.
    assert found == pytest.approx({jobs[0]: 2000.0, jobs[1]: 20.0})


def test_a_job_is_as_fast_as_those_most_like_it(desk):
    measured = {
        Job("train", "dragon"): 200.0,
        Job("train", "dragon_64"): 100.0,
        Job("train", "fence_field"): 30.0,
        Job("evaluate", "fence.shadow.000"): 50.0,
    }
    network = Job("train", "fence")  # the same network as the dragon's
    encoding = Job("train", "dragon_128")  # that and the narrow one
    rule = Job("train", "dragon_ray_grid")  # all three, 80 million samples in 330 s
    other = Job("evaluate", "dragon.surface.001")  # as many methods
    unknown = Job("generate_mesh", "fence")
    jobs = [network, encoding, rule, other, unknown]
    found = expected_seconds(jobs, desk, measured, desk)
    assert unknown not in found
    assert found[network] == pytest.approx(200)
    assert found[encoding] == pytest.approx(150)
    samples = work_of(desk, rule)
    assert found[rule] == pytest.approx(330 * samples / (2 * 20_480_000 + 600 * 65_536))
    assert found[other] == pytest.approx(50)


def test_submissions():
    counts = {"sample_rays": 25, "label_rays": 25, "train": 3, "table": 4, "claims": 1}
    counts["find_lpips"] = 1
    groups = {"sample_rays": "rays", "label_rays": "rays", "table": "end", "claims": "end"}
    assert submissions(counts, groups, {"rays": 10, "end": 100}) == {
        "rays": 3,
        "train": 3,
        "end": 1,
    }


def test_report(desk, large):
    jobs = [Job("train", "dragon")] + [
        Job("label_rays", f"dragon.poisson_quadtree.{shard:03d}") for shard in range(10)
    ]
    measured = {
        Job("train", "dragon"): 3600.0,
        Job("label_rays", "dragon.poisson_quadtree.000"): 18.0,
    }
    text = plan_report(
        jobs,
        large,
        measured,
        desk,
        groups={"label_rays": "rays"},
        components={"rays": 5},
        nodes=[1, 2],
        cores=8,
    )
    # Ten hours on the two cores of the measured run are 20 core-hours, and 2.5 hours on eight.
    train = next(line for line in text.splitlines() if line.startswith("| train"))
    assert [part.strip() for part in train.split("|")[2:-1]] == [
        *("1", "", "8", "2.05e+08 samples", "20", "20")
    ]
    # 100 million rays of 20 bytes; 2.5 million took 18 s on two cores.
    assert "11 jobs, 3 of Slurm's; 20 core-hours; the rays take 2 GB." in text
    hours = [line.split("|")[2].strip() for line in text.splitlines()[-2:]]
    assert hours == ["2.55", "2.5"]  # a second node cannot share the training


@pytest.mark.parametrize(
    "rules, line", [(MANY_CORES, "threads: CONFIG.compute.threads"), (LOCAL, "localrule: True")]
)
def test_rules_are_those_of_the_workflow(rules, line):
    text = "\n".join(path.read_text() for path in (ROOT / "workflow" / "rules").glob("*.smk"))
    of_rules = re.split(r"^rule ", text, flags=re.MULTILINE)[1:]
    assert {re.match(r"\w+", rule)[0] for rule in of_rules if line in rule} == set(rules)


def test_measured_times_are_read_from_both_forms(tmp_path):
    folder = tmp_path / "benchmarks" / "train"
    folder.mkdir(parents=True)
    (folder / "dragon.tsv").write_text("s\th:m:s\tmax_rss\n12.5\t0:00:12\t900.1\n")
    (folder / "fence.tsv").write_text("s\th:m:s\tmax_rss\n7\t0:00:07\t900.1\n")
    table = tmp_path / "jobs.csv"
    table.write_text("rule,job,seconds\ntrain,dragon,12.5\ntrain,fence,7\n")
    expected = {Job("train", "dragon"): 12.5, Job("train", "fence"): 7.0}
    assert read_measured(folder.parent) == read_measured(table) == expected


def test_nothing_measured_is_said(tmp_path):
    with pytest.raises(InputError, match=r"nowhere: no such file or folder; name a run's"):
        read_measured(tmp_path / "nowhere")
    with pytest.raises(InputError, match="no benchmark files there; run the workflow first"):
        read_measured(tmp_path)
