"""What tables and figures are made of beside their rows."""

import pytest

from neural_shadows.layout import kinds, tables
from neural_shadows.layout.layout import Layout

ROW = {"scene": "dragon", "method": "dragon", "experiment": "dragon", "bias": 0.0}
SETTINGS = {
    "scale": "desk",
    "rendering": {"views_per_set": 4, "batch": 2},
    "samplings": {"uniform": {"shards": 2}},
    "experiments": {
        "dragon": {"scene": "dragon", "sampling": "uniform"},
        "mesh": {"scene": "dragon", "sampling": None},
    },
    "figures": {
        "figure_pictures": {"kind": "pictures", "scene": "dragon", "rows": [ROW]},
        "figure_loss": {"kind": "loss", "curves": [{"experiment": "dragon", "label": "Dragon"}]},
    },
}


@pytest.fixture
def layout() -> Layout:
    return Layout(SETTINGS)


def test_jobs_between_a_mesh_and_its_network(layout):
    shards = [f"dragon.uniform.{part}" for part in ("000", "001")]
    assert tables.before_training(layout, "dragon") == [
        "results/benchmarks/prepare_mesh/dragon.tsv",
        "results/benchmarks/draw_directions/dragon.uniform.tsv",
        *(f"results/benchmarks/sample_rays/{shard}.tsv" for shard in shards),
        *(f"results/benchmarks/label_rays/{shard}.tsv" for shard in shards),
    ]
    # What is only built needs no rays.
    built = ["results/benchmarks/prepare_mesh/dragon.tsv"]
    assert tables.before_training(layout, "mesh") == built


def test_pictures_are_judged_by_all_views_and_by_no_shadow(layout):
    made = kinds.files(layout, "figures", "figure_pictures")
    names = [f"{method}.{part}" for method in ("dragon", "no_shadow") for part in ("000", "001")]
    assert made["metrics"] == [f"results/evaluations/dragon/{name}.csv" for name in names]
    answered = [f"results/evaluations/dragon/dragon.{part}.npz" for part in ("000", "001")]
    assert made["visibilities"] == answered
    seen = [f"results/references/dragon/{part}.safetensors" for part in ("000", "001")]
    assert made["references"] == seen


def test_losses_come_with_what_became_of_their_trainings(layout):
    made = kinds.files(layout, "figures", "figure_loss")
    assert made["losses"] == ["results/networks/dragon/loss.csv"]
    assert made["trainings"] == ["results/networks/dragon/training.json"]
