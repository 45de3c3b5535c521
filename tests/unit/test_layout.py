"""What the rules look up: files of tables, figures, batches and shards."""

import re
from pathlib import Path

import pytest
import yaml

from neural_shadows.config import read_config
from neural_shadows.layout import Layout, one_of, part_range

ROOT = Path(__file__).parents[2]


@pytest.fixture
def layout() -> Layout:
    return Layout(read_config(yaml.safe_load((ROOT / "config" / "config.yaml").read_text())))


def test_parts_cover_the_whole_once():
    for total, parts in ((10, 3), (3, 3), (2000, 4), (7, 2)):
        ranges = [part_range(total, parts, part) for part in range(parts)]
        assert [first for first, _ in ranges] == [0, *(last for _, last in ranges[:-1])]
        assert ranges[-1][1] == total
        sizes = [last - first for first, last in ranges]
        assert max(sizes) - min(sizes) <= 1


def test_a_table_of_two_evaluations_reads_both_on_the_same_viewpoints(layout):
    paths = layout.table_batches("table_4_1", "csv")
    by_evaluation = {}
    for path in paths:
        folder, name = path.rsplit("/", 1)
        by_evaluation.setdefault(folder, []).append(name)
    assert list(by_evaluation) == [
        "results/evaluations/dragon",
        "results/evaluations/dragon_sampling",
    ]
    first, second = by_evaluation.values()
    assert first == second == ["shadow.000.csv", "shadow.001.csv", *second[2:]]
    assert second[2:] == ["surface.000.csv", "surface.001.csv"]


def test_tables_of_the_dragon_share_its_base_network(layout):
    base = "results/networks/dragon/weights.safetensors"
    for number in (1, 2, 3):
        assert base in layout.table_networks(f"table_4_{number}", "weights.safetensors")
    assert layout.table_networks("table_4_3", "training.json") == [
        "results/networks/dragon/training.json"
    ]


def test_a_figure_shows_the_first_view_of_its_view_sets_alone(layout):
    assert layout.first_batches("figure_4_4", "npz") == [
        "results/evaluations/dragon/shadow.000.npz"
    ]
    assert layout.first_batches("figure_4_6", "csv") == [
        "results/evaluations/fence/shadow.000.csv",
        "results/evaluations/fence/surface.000.csv",
    ]


def test_only_the_single_axis_rays_are_drawn_for_the_light_alone(layout):
    assert layout.sampling_light("landscape", "poisson_quadtree") is None
    assert layout.sampling_light("landscape", "single_axis") == {
        "domain": "single_axis",
        "axis": "z",
        "min_elevation_deg": 20,
    }


def test_one_of_matches_its_names_alone():
    assert re.fullmatch(one_of(["table_a", "table_b"]), "table_b")
    assert not re.fullmatch(one_of(["table_a"]), "table_ab")
    assert not re.fullmatch(one_of([]), "")


def test_rule_all_asks_for_each_table_and_figure_of_the_config(layout):
    made = layout.all_reports()
    assert len(set(made)) == len(made)
    for name in layout.config.tables:
        assert {f"reports/{name}.csv", f"reports/{name}.md"} <= set(made)
    for name in layout.config.figures:
        assert {f"reports/{name}.png", f"reports/{name}.svg"} <= set(made)
