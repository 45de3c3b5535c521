"""Where files lie, which part a job does, what a table is made of, and what is there by default."""

import pytest
from shipped import shipped

from neural_shadows.config.reading import read_config
from neural_shadows.config.resolved import resolved
from neural_shadows.errors import InputError
from neural_shadows.layout import claims, tables, targets
from neural_shadows.layout.layout import Layout
from neural_shadows.layout.parts import HELD_OUT, batches, part_range, view_range

RENDERING = {"views_per_set": 25, "batch": 12, "held_out_views": 8}


def layout_of(*overlays: str, **values) -> Layout:
    """The layout of the shipped configuration with overlays."""
    return Layout(resolved(read_config(shipped(*overlays, **values))))


@pytest.fixture(autouse=True)
def no_opengl(monkeypatch):
    """As on a machine without; an EGL that has started would crash a later import of triton."""
    monkeypatch.setattr(targets.opengl, "available", lambda: False)


@pytest.fixture(scope="module")
def desk() -> Layout:
    return layout_of()


def test_parts_follow_each_other():
    assert [part_range(25, 3, part) for part in range(3)] == [(0, 8), (8, 16), (16, 25)]
    assert [part_range(2, 3, part) for part in range(3)] == [(0, 0), (0, 1), (1, 2)]
    assert batches(RENDERING) == ["000", "001", "002"]
    ranges = [view_range(RENDERING, batch) for batch in [*batches(RENDERING), HELD_OUT]]
    assert ranges == [(0, 12), (12, 24), (24, 25), (25, 33)]


def test_files_lie_below_the_scale_s_name(desk):
    smoke = layout_of("smoke")
    assert desk.paths.report("table_4_3.csv") == "reports/table_4_3.csv"
    assert smoke.paths.report("table_4_3.csv") == "reports/smoke/table_4_3.csv"
    log = smoke.paths.log("label_rays", "scene", "shard")
    assert log == "results/smoke/logs/label_rays/{scene}.{shard}.log"
    assert desk.paths.log("find_lpips") == "results/logs/find_lpips/find_lpips.log"


def test_source_of_a_mesh():
    mesh = {"generate": None, "path": "meshes/mine.ply"}
    layout = layout_of(scenes={"fence": {"mesh": mesh}}, dragon="stanford")
    assert layout.mesh_source("dragon") == "results/scenes/dragon/downloaded.ply"
    assert layout.mesh_source("fence") == "meshes/mine.ply"
    assert layout.mesh_source("landscape") == "results/scenes/landscape/generated.ply"
    about = layout.scenes(["fence", "landscape"])
    assert [scene["procedural"] for scene in about.values()] == [False, True]
    assert about["fence"]["mesh_name"] == "mine"


def test_files_of_a_training(desk):
    thesis, field = map(desk.training_files, ("dragon", "dragon_field"))
    # An edited mesh of a network that needs none reaches it through its rays.
    assert thesis["mesh_ply"] == [] and field["mesh_ply"] == ["results/scenes/dragon/mesh.ply"]
    shards = [f"results/rays/dragon/poisson_quadtree/bounds.{i:03d}.npy" for i in range(4)]
    assert thesis["bounds"] == shards


@pytest.mark.parametrize(
    ("method", "bias", "weights", "files"),
    [
        ("shadow_map_512", None, 0, 0),
        ("dragon", 0.0, 1, 0),
        ("dragon_biased", HELD_OUT, 1, 1),
        ("dragon_field", HELD_OUT, 1, 1),
    ],
)
def test_files_of_a_method(desk, method, bias, weights, files):
    assert desk.bias(method) == bias
    name = method.removesuffix("_biased")
    weight_files = [f"results/networks/{name}/weights.safetensors"]
    assert desk.weights(method) == weight_files * weights
    assert desk.bias_file(method) == [f"results/depth_biases/{name}.json"] * files
    assert desk.method_encodings(method) == (desk.encodings([name]) if weights else set())


def test_a_table_is_made_of_its_rows(desk):
    made = tables.files(desk, "table_4_3")
    assert made["mesh_json"] == ["results/scenes/dragon/mesh.json"]
    assert made["published_csv"] == "config/published.csv"
    assert "results/evaluations/dragon/shadow_map_512.001.csv" in made["metrics"]
    networks = ["dragon", "dragon_field"]
    assert made["trainings"] == [f"results/networks/{name}/training.json" for name in networks]
    assert made["depth_biases"] == ["results/depth_biases/dragon_field.json"]
    assert "reports/scenes/dragon.png" in made["beside"]
    # An edited network's code leaves a table alone that reads none of its files.
    assert tables.encodings(desk, "table_4_3") == set()
    assert tables.encodings(desk, "table_4_7") == {"frequency"}


def test_claims_are_tested_on_the_methods_that_they_name(desk):
    made, told = claims.files(desk), claims.arguments(desk)
    assert "results/evaluations/dragon/dragon_uniform.000.csv" in made["metrics"]
    assert "results/networks/dragon_high_rate/loss.csv" in made["losses"]
    assert "results/frame_times/table_4_6/dragon.json" in made["times"]
    assert told["samples"] == 20000 * 1024


@pytest.mark.parametrize(
    ("look_up", "message"),
    [
        (lambda layout: tables.files(layout, "table_4_33"), "tables: .*did you mean 'table_4_3'"),
        (lambda layout: layout.training_files("dragn"), "experiments: .*did you mean 'dragon'"),
        (lambda layout: layout.mesh_source("teapot"), "scenes: .*dragon, fence, landscape"),
    ],
)
def test_names_that_there_are_not(desk, look_up, message):
    with pytest.raises(InputError, match=message):
        look_up(desk)


def test_what_is_made_by_default(desk):
    reports = targets.all_reports(desk)
    assert {"reports/table_4_3.csv", "reports/index.html", "reports/claims.md"} <= {*reports}
    assert not any("ablations" in path or "figure_3d" in path for path in reports)
    assert "figure_beyond_slice" in targets.beyond(desk) and "table_4_3" not in targets.beyond(desk)
    page = targets.page_files(desk)
    assert "results/references/dragon/000.npz" in page["pictures"]
    names = [(row["scene"], row["method"]) for row in targets.pictured(desk)]
    assert len(names) == len(set(names)) and ("dragon", "ray_traced") not in names


def test_a_page_of_what_is_there(desk, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    assert targets.newest(desk) == 0
    made = tmp_path / "reports" / "table_4_1.md"
    made.parent.mkdir()
    made.touch()
    told = targets.available_arguments(desk)
    assert told["tables"] == ["reports/table_4_1.md"]
    assert told["figures"] == told["claims_md"] == told["lpips_json"] == []
    assert targets.newest(desk) == made.stat().st_mtime


def test_the_words_at_the_end(desk, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "20")
    (tmp_path / "reports").mkdir()
    (tmp_path / "reports" / "a.md").write_text(
        "| a row that is too wide |\n| short |\n\n- a note\n"
    )
    made = ["results/lpips.json", "reports/a.csv", "reports/a.md", "reports/figure_1.png"]
    assert targets.closing_words(desk, made).splitlines() == [
        "| a row that is too…",
        "| short |",
        "Open reports/a.md, reports/figure_1.png",
    ]
    whole = targets.closing_words(desk, [*made, "reports/index.html"])
    assert whole.endswith("\nOpen reports/index.html")
    assert targets.closing_words(desk, made[:1]) == ""
