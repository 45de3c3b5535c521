"""What the rules look up: files of tables, figures, batches and shards."""

import re
from pathlib import Path

import pytest
import yaml

from neural_shadows.config.reading import read_config
from neural_shadows.layout.layout import Layout, one_of, part_range

ROOT = Path(__file__).parents[3]


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
        assert base in layout.table_files(f"table_4_{number}", "weights.safetensors")
    assert layout.table_trainings("table_4_3") == [
        "results/networks/dragon/training.json",
        "results/networks/dragon_field/training.json",
    ]


def test_a_figure_shows_the_first_view_of_its_view_sets_alone(layout):
    assert layout.first_batches("figure_4_4", "npz") == [
        "results/evaluations/dragon/shadow.000.npz",
        "results/evaluations/dragon_field/shadow.000.npz",
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
    for name, table in layout.config.tables.items():
        wanted = {f"reports/{name}.csv", f"reports/{name}.md"}
        assert wanted & set(made) == (set() if getattr(table, "on_request", False) else wanted)
    for name in layout.config.figures:
        assert {f"reports/{name}.png", f"reports/{name}.svg"} <= set(made)


def test_what_is_made_on_request_is_no_part_of_the_page(layout):
    assert "ablations" in layout.config.tables and "ablations" not in layout.usual_tables()
    assert "beyond" in layout.usual_tables()
    evaluations = layout.usual_evaluations()
    assert "dragon_ablations" not in evaluations and "dragon_field" in evaluations
    experiments = layout.usual_experiments()
    assert not [name for name in experiments if name.startswith("ablation")]
    assert len(set(experiments)) == len(experiments) == 37
    pictures = [path for paths in layout.first_batches_by_scene("npz").values() for path in paths]
    assert not [path for path in pictures if "ablations" in path]


def test_biases_come_from_views_that_no_evaluation_renders(layout):
    rendered = {view for part in range(2) for view in range(*layout.view_range(f"{part:03d}"))}
    assert rendered == set(range(layout.config.rendering.views_per_set))
    assert not rendered & set(range(*layout.held_out_range()))
    assert layout.depth_biases("dragon") == []
    assert layout.depth_biases("dragon_field") == [
        "results/evaluations/dragon_field/depth_biases.json"
    ]
    assert layout.export_biases("dragon_field") == layout.depth_biases("dragon_field")
    assert layout.export_biases("dragon_uniform") == layout.export_biases("dragon") == []
    assert layout.export_bias("dragon") == 0
    given = layout.given_biases("beyond")
    assert given["dragon"] == 0 and "dragon_biased" not in given


def test_claims_are_judged_by_the_samples_of_their_own_networks(layout):
    assert layout.most_samples() == 20_000 * 1024


def test_the_mesh_is_an_input_only_of_trainings_that_need_it(layout):
    assert layout.training_mesh("dragon") == layout.training_mesh("dragon_ray_grid") == []
    for name in ("dragon_occupancy_grid", "dragon_hash_grid", "dragon_field"):
        assert layout.training_mesh(name) == ["results/scenes/dragon/mesh.ply"]


def test_a_figure_draws_its_scene_and_its_methods(layout):
    rows = layout.figure_rows("figure_beyond_fence")
    assert rows[0]["method"] == "ray_traced" and rows[-1]["method"] == "fence_biased"
    assert all("dragon" not in row["method"] for row in rows)
    drawn = [row["method"] for row in layout.picture_rows("figure_beyond_pictures_fence")]
    named = layout.config.figures["figure_beyond_pictures_fence"].methods
    assert sorted(drawn) == sorted(named)
    assert len(layout.picture_rows("figure_4_4")) == 7


def test_an_experiment_has_its_scene_s_seed_or_its_own(layout):
    assert layout.experiment_seed("ablation_grid") == layout.config.seed
    assert layout.experiment_seed("ablation_seed_2") == 2


def test_domains_of_view_directions(layout):
    assert layout.sampling_light("dragon", "hemisphere") == {
        "domain": "sphere",
        "min_elevation_deg": 0,
    }
