"""Expected seconds beside those of a run, and the table of them."""

from functools import cache

import pytest
from shipped import shipped

from neural_shadows.config.reading import read_config
from neural_shadows.config.resolved import resolved
from neural_shadows.layout.layout import Layout
from neural_shadows.reports.costs import expected_minutes as stage
from neural_shadows.reports.costs.work import REFERENCE_RATES, Work, work_of

RATES = {**REFERENCE_RATES, "device": "cpu", "precision": "float32"}
VIEWS = {"frame_set": "views", "group": "dragon.000"}
# What was computed: the shipped configuration may change.
AS_MEASURED = {
    "trainings": {
        "base": {"steps": 20000, "batch_size": 1024},
        "nsm": {"steps": 1000, "crops": 4, "crop": 256},
        "kpnsm": {"steps": 600, "crops": 4, "crop": 256},
    },
    "frame_sets": {
        "views": {"width": 600, "height": 400, "views_per_set": 24, "batch": 12},
        "frames": {"train": 48, "validation": 2, "test": 2, "sequence": 5, "shard": 16},
        "windows": {"test": 2, "unseen_test": 3, "sequence": 5},
    },
}

# Seconds of jobs of `snakemake reports/table_4_3.csv` alone on the machine of `REFERENCE` (commit
# c175dee: training.json of `dragon`, else results/benchmarks; evaluations by FLIP of tiles).
MEASURED = [
    ("get_mesh", {"scene": "dragon"}, 6.0),
    ("prepare_mesh", {"scene": "dragon"}, 1.8),
    *[
        ("sample_rays", {"scene": "dragon", "sampling": "poisson_quadtree", "shard": shard}, s)
        for shard, s in (("000", 4.7), ("001", 12.9), ("002", 4.6), ("003", 4.7))
    ],
    ("train", {"experiment": "dragon"}, 1064.8),
    ("train", {"experiment": "dragon_field"}, 50.7),
    ("tune", {"frame_set": "views", "group": "dragon", "method": "dragon_field"}, 33.6),
    # Of networks, whose answers and metrics were two jobs then, the first and an `all_dark`.
    *[
        ("evaluate", {**VIEWS, "group": f"dragon.{batch}", "method": method}, s + 4.4)
        for method, of_batches in {"dragon": (129.8, 96.0), "dragon_field": (5.7, 5.6)}.items()
        for batch, s in zip(("000", "001"), of_batches)
    ],
    *[
        ("render_references", {"scene": "dragon", "batch": batch}, s)
        for batch, s in (("000", 7.1), ("001", 5.1), ("held_out", 6.6))
    ],
    ("evaluate", {**VIEWS, "method": "all_dark"}, 4.4),
    ("evaluate", {**VIEWS, "method": "shadow_map_2048"}, 6.5),
]


@cache
def measured_layout() -> Layout:
    return Layout(resolved(read_config(shipped(**AS_MEASURED))))


def seconds(layout: Layout, rule: str, wildcards: dict[str, str]) -> float:
    work = vars(work_of(layout, rule, wildcards))
    job = {"rule": rule, "name": "", "threads": 2 if rule == "train" else 1, "work": work}
    return stage.seconds_of(job, RATES, cores=2)


def test_expected_seconds_of_a_measured_run():
    layout = measured_layout()
    expected = [seconds(layout, rule, names) for rule, names, _ in MEASURED]
    measured = [of_job for *_, of_job in MEASURED]
    assert sum(measured) / 2 < sum(expected) < 2 * sum(measured)
    without_training = [
        (one, other) for one, other, job in zip(expected, measured, MEASURED) if job[0] != "train"
    ]
    one, other = map(sum, zip(*without_training))
    assert other / 2 < one < 2 * other


@pytest.mark.parametrize(
    ("rule", "wildcards", "measured"),
    [
        # The same machine, beside other work (commits ec6b6ff and 2ae880a, 77 and 50 minutes in all).
        ("evaluate", {"frame_set": "frames", "group": "all", "method": "exact_centre"}, 330),
        ("evaluate", {"frame_set": "frames", "group": "all", "method": "rt_64"}, 330),
        ("evaluate", {"frame_set": "frames", "group": "all", "method": "rt_4_oidn"}, 244),
        ("evaluate", {"frame_set": "frames", "group": "all", "method": "cone_8"}, 232),
        ("evaluate", {"frame_set": "frames", "group": "all", "method": "hard"}, 39),
        ("evaluate", {"frame_set": "windows", "group": "all", "method": "kpnsm"}, 120),
        # Seconds of processor beside other work, with a history on five sequences.
        ("tune", {"frame_set": "frames", "group": "all", "method": "rt_1_sigma_ffx"}, 165),
        # At b0133606, likewise.
        ("tune", {"frame_set": "frames", "group": "all", "method": "rt_1_ffx"}, 136),
        # At 7da25797, beside other work: 87 and 117 seconds of processor.
        ("tune", {"frame_set": "frames", "group": "all", "method": "rt_4_ffx"}, 190),
        ("tune", {"frame_set": "frames", "group": "all", "method": "rt_4_svgf"}, 183),
        # Of 16 settings then, of 20 later; a second round takes 0.37 of the first's time.
        ("tune", {"frame_set": "frames", "group": "all", "method": "pcss"}, 1.37 * 70 * 20 / 16),
        ("render_frames", {"frame_set": "frames", "scene": "atrium", "part": "train_000"}, 42),
        ("fit_fields", {"frame_set": "frames"}, 352),
        ("measure_frames", {"frame_set": "frames", "measure": "widths.json"}, 49),
        ("train", {"experiment": "kpnsm"}, 627),
        ("train", {"experiment": "nsm"}, 1242),
    ],
)
def test_expected_seconds_of_frames(rule, wildcards, measured):
    expected = seconds(measured_layout(), rule, wildcards)
    assert measured / 2 < expected < 2 * measured


def test_work_adds_and_scales():
    work = Work(seconds=1, rays=2) + Work(seconds=3, products=5) * 2
    assert work == Work(seconds=7, products=10, rays=2)


def test_a_job_counts_once_and_on_its_cores(monkeypatch):
    monkeypatch.setattr(stage, "measure_rates", lambda device, precision: RATES)
    work = vars(Work(seconds=60))
    jobs = [
        {"rule": rule, "name": name, "threads": threads, "work": work}
        for rule, name, threads in (("train", "a", 2), ("evaluate", "b", 1), ("evaluate", "c", 1))
    ]
    targets = {"everything": [0, 1, 2], "one.csv": [0, 1], "other.csv": [1]}
    table = stage.expected_minutes(jobs, targets, cores=2, scale="desk").data
    # A job on both cores, beside two that share them; a report takes its longest job at least.
    assert dict(zip(table["report"], table["minutes"])) == pytest.approx(
        {"everything": 2, "one.csv": 1.5, "other.csv": 1}
    )
    assert table["most_of_it"][0] == "train 1.0, evaluate 1.0"


def test_a_job_takes_longer_on_a_slower_machine():
    job = {"rule": "train", "name": "", "threads": 1, "work": vars(Work(4, 6, 20.4, 21.5, 3.0))}
    assert stage.seconds_of(job, RATES, 2) == pytest.approx(13)
    assert stage.seconds_of(job, RATES | {"products": 10.2}, 2) == pytest.approx(14)
    assert stage.seconds_of(job, RATES | {"start": 8.2}, 2) == pytest.approx(17)
    assert stage.seconds_of(job, RATES | {"loops": RATES["loops"] / 2}, 2) == pytest.approx(19)
    # Threads help what a network multiplies, and nothing on one core.
    assert stage.seconds_of(job | {"threads": 2}, RATES, 2) == pytest.approx(11 + 2 / 1.85)
    assert stage.seconds_of(job | {"threads": 2}, RATES, 1) == pytest.approx(13)
