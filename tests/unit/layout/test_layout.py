"""Where files lie, which part a job does, what a table is made of, and what is there by default."""

import pytest
from shipped import shipped

from neural_shadows.config.reading import read_config
from neural_shadows.config.resolved import resolved
from neural_shadows.errors import InputError
from neural_shadows.layout import frame_sets, kinds, soft_methods, tables
from neural_shadows.layout.layout import Layout
from neural_shadows.layout.parts import HELD_OUT, batches, part_range, view_range
from neural_shadows.reports.claims import inputs as claims
from neural_shadows.reports.page import targets


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
    rendering = {"views_per_set": 25, "batch": 12, "held_out_views": 8}
    assert batches(rendering) == ["000", "001", "002"]
    ranges = [view_range(rendering, batch) for batch in [*batches(rendering), HELD_OUT]]
    assert ranges == [(0, 12), (12, 24), (24, 25), (25, 33)]


def test_sources_of_meshes_and_folders_of_scales():
    mesh = {"generate": None, "path": "meshes/mine.ply"}
    layout = layout_of(scenes={"fence": {"mesh": mesh}}, dragon="stanford")
    assert layout.mesh_source("dragon") == "results/scenes/dragon/downloaded.ply"
    assert layout.mesh_source("fence") == "meshes/mine.ply"
    assert layout.mesh_source("landscape") == "results/scenes/landscape/generated.ply"
    assert layout_of("smoke").paths.report("table.csv") == "reports/smoke/table.csv"


def test_files_of_a_training(desk):
    thesis, field = map(desk.training_files, ("dragon", "dragon_field"))
    assert thesis["rays_json"] == "results/rays/dragon/poisson_quadtree/rays.json"
    # An edited mesh of a network that needs none reaches it through its rays.
    assert thesis["mesh_ply"] == [] and field["mesh_ply"] == ["results/scenes/dragon/mesh.ply"]
    shards = [f"results/rays/dragon/poisson_quadtree/bounds.{i:03d}.npy" for i in range(4)]
    assert thesis["bounds"] == shards
    # One that is only built is made of no rays: a stage is told so by the same names.
    built = {**desk.settings["experiments"]["dragon_field"], "sampling": None, "training": None}
    made = Layout({**desk.settings, "experiments": {"built": built}}).training_files("built")
    assert made["mesh_ply"] == field["mesh_ply"] and made.keys() == field.keys()
    assert made["origins"] == made["bounds"] == made["directions_npy"] == made["rays_json"] == []


def test_files_of_methods(desk):
    assert desk.bias("shadow_map_512") is None and desk.bias("dragon") == 0
    assert desk.bias_file("dragon", "dragon") == desk.bias_file("dragon", "shadow_map_512") == []
    for method in ("shadow_map_512", "shadow_map_pcf_512_biased", "no_shadow"):
        assert desk.weights(method) == [] and desk.method_encodings(method) == set()
    assert desk.weights("dragon_biased") == ["results/networks/dragon/weights.safetensors"]
    assert desk.method_encodings("dragon_biased") == {"frequency"}
    for method in ("dragon_biased", "dragon_field", "shadow_map_512_biased"):
        assert desk.bias(method) == HELD_OUT
        name = method.removesuffix("_biased")
        found = [f"results/depth_biases/dragon/{name}.json"]
        assert desk.bias_file("dragon", method) == found
        if name != "shadow_map_512":
            assert desk.export_files(name)["depth_bias_json"] == desk.bias_file("dragon", name)


def test_what_reserves_a_gpu(desk):
    """Networks that compute on one: what is only built trains nothing, and a mesh asks Embree."""
    methods = ["dragon_biased", "dragon_distances_256", "dragon_mesh_biased", "shadow_map_512"]
    assert [desk.can_use_gpu(method) for method in methods] == [True, True, False, False]
    trained = [desk.is_trained(name) for name in ("dragon", "dragon_distances_256", "dragon_mesh")]
    assert trained == [True, False, False]


def test_violations_are_counted_for_the_claims_about_them():
    claim = {"kind": "violations", "methods": ["fence"], "section": "5.1", "statement": "so"}
    layout = layout_of("claims", claims={"lower_bound_costs_more": claim})
    counted = [claims.counts_violations(layout, method) for method in ("fence", "dragon")]
    assert counted == [True, False]
    point = layout.settings["learning_curves"]["fence"][0]["experiment"]
    assert claims.counts_violations(layout, point) and not claims.counts_violations(layout, "x")


def test_files_that_methods_are_evaluated_from(desk):
    """Networks from their answers alone, whatever their bias; others from the mesh."""
    network = desk.evaluated_files("dragon", "dragon_biased", "000")
    answers = "results/answers/dragon/dragon_biased.000.npz"
    assert network == {"answers": answers, "mesh_ply": [], "depth_bias_json": []}
    for method, bias in {"shadow_map_512_biased": "shadow_map_512", "no_shadow": None}.items():
        files = desk.evaluated_files("dragon", method, "000")
        assert files["answers"] == [] and files["mesh_ply"] == "results/scenes/dragon/mesh.ply"
        found = [f"results/depth_biases/dragon/{bias}.json"] if bias else []
        assert files["depth_bias_json"] == found


def test_unseen_scenes_may_have_more_test_frames():
    layout = layout_of(frame_sets={"windows": {"unseen_test": 20}})
    parts = {
        (scene, use): [
            path.rsplit("/", 1)[1].removesuffix(".json")
            for path in frame_sets.parts(layout, scene, "windows", use)
        ]
        for scene in ("hall", "tree")
        for use in ("validation", "test")
    }
    assert parts["hall", "test"] == ["test_000"]
    assert parts["tree", "test"] == ["test_000", "test_001"]
    assert parts["tree", "validation"] == ["validation_000"]
    last = [
        frame_sets.frame_settings(layout, scene, "windows", part)["last"]
        for scene, part in (("hall", "test_000"), ("tree", "test_000"), ("tree", "test_001"))
    ]
    assert last == [2, 16, 20]


def test_steps_are_measured_in_their_number_formats(desk):
    made = kinds.table_files(desk, "nsm_steps")
    assert [path.rsplit("/", 1)[1] for path in made["soft_metrics"]] == [
        *("nsm_trimmed_float32.csv", "nsm_trimmed_bfloat16.csv", "nsm_bfloat16.csv"),
        *("no_shadow.csv", "all_dark.csv", "hard.csv"),  # what learns nothing
    ]
    method = "nsm_trimmed_float32"
    assert soft_methods.precision(desk, method) == "float32"
    assert soft_methods.weights(desk, method) == soft_methods.weights(desk, "nsm_trimmed")
    assert soft_methods.precision(desk, "nsm_trimmed") == "auto"


def test_a_network_for_each_scene_is_by_scene(desk):
    methods = ("kpnsm_nsm_single", "kpnsm_nsm_joint", "pcss")
    assert [soft_methods.by_scene(desk, one) for one in methods] == [True, False, False]


def test_tables_and_claims_are_made_of_their_rows(desk):
    made = kinds.table_files(desk, "table_4_3")
    assert "results/evaluations/dragon/shadow_map_512.001.csv" in made["metrics"]
    networks = ["dragon", "dragon_field"]
    assert made["trainings"] == [f"results/networks/{name}/training.json" for name in networks]
    assert made["depth_biases"] == ["results/depth_biases/dragon/dragon_field.json"]
    assert "results/evaluations/dragon/all_dark.000.csv" in made["metrics"]
    assert "reports/scenes/dragon.png" in made["beside"]
    # An edited network's code leaves a table alone that reads none of its files.
    encodings = [kinds.encodings(desk, "tables", name) for name in ("table_4_3", "table_4_7")]
    assert encodings == [set(), {"frequency"}]
    judged = claims.files(desk)
    assert "results/networks/dragon_high_rate/loss.csv" in judged["losses"]
    # Not timed, but in a pair: its record says how long it was trained.
    assert "results/networks/landscape_axis_128/training.json" in judged["trainings"]
    for scene in ("dragon", "fence", "landscape"):
        assert f"results/evaluations/{scene}/no_shadow.000.csv" in judged["metrics"]
        assert f"results/scenes/{scene}/mesh.json" in judged["meshes"]
    assert judged["published_csv"] == "config/published.csv"
    assert claims.arguments(desk)["learning_curves"] == {}
    with pytest.raises(InputError, match="tables: .*did you mean 'table_4_3'"):
        kinds.table_files(desk, "table_4_33")


@pytest.mark.parametrize("name", ["kpnsm_forty_rays_are_better", "kpnsm_rays_at_equal_time"])
def test_claims_on_networks_of_frames_read_all_their_trainings(name):
    layout = layout_of("kpnsm_seeds")
    layout.settings["claims"] = {name: layout.settings["claims"][name]}
    judged = claims.files(layout)
    for network in ("kpnsm", "kpnsm_seed_1", "kpnsm_basic_seed_2"):
        record = f"results/screen_networks/{network}/training.json"
        assert record in judged["screen_trainings"]
        assert layout.paths.soft_evaluation("csv", "windows", network) in judged["soft_metrics"]


def test_files_of_learning_curves():
    layout = layout_of("claims")
    names = [point["experiment"] for point in layout.settings["learning_curves"]["dragon_uniform"]]
    assert len(names) == 15 and names[-3] == "dragon_uniform"
    made, judged = kinds.table_files(layout, "learning_sampling"), claims.files(layout)
    for found in (made, judged):
        for name in names:
            assert f"results/claims/evaluations/dragon/{name}.000.csv" in found["metrics"]
            assert f"results/claims/networks/{name}/training.json" in found["trainings"]
        assert "results/claims/evaluations/dragon/no_shadow.000.csv" in found["metrics"]
    for name in names:
        assert f"results/claims/networks/{name}/loss.csv" in made["losses"]
    told = kinds.params(layout, "tables", "learning_sampling")
    assert [*told["curves"]] == [row["method"] for row in told["rows"]]
    assert [*told["curves"]] == ["dragon", "dragon_uniform_quadtree", "dragon_uniform"]
    assert "fence" in claims.arguments(layout)["learning_curves"]
    biased = {**told["rows"][0], "method": "dragon_biased"}
    methods = [row["method"] for row in tables.with_curves(layout, [biased])]
    assert methods[:2] == ["dragon_biased", "dragon_500_steps_seed_2026_biased"]
    assert kinds.files(layout, "figures", "figure_learning_fence") == {
        "table": "reports/claims/learning_networks.csv"
    }
    told = kinds.params(layout, "figures", "figure_learning_fence")
    assert [row["method"] for row in told["rows"]] == ["fence"]
    assert targets.chapters(layout)["figure_learning_fence"] == "thesis"


def test_durations_are_of_what_comes_before_a_training(desk):
    told = kinds.params(desk, "tables", "beyond")["durations"]["landscape_field_axis"]
    assert told[:2] == [
        "results/benchmarks/prepare_mesh/landscape.tsv",
        "results/benchmarks/draw_directions/landscape.single_axis.tsv",
    ]
    assert told[-1] == "results/benchmarks/label_rays/landscape.single_axis.003.tsv"
    assert len(told) == 2 + 2 * 4


def test_what_is_made_by_default(desk):
    reports = targets.all_reports(desk)
    assert {"reports/table_4_3.csv", "reports/index.html", "reports/claims.md"} <= {*reports}
    assert not any("ablations" in path or "figure_3d" in path for path in reports)
    names = [(row["scene"], row["method"]) for row in targets.pictured(desk)]
    assert len(names) == len(set(names)) and ("dragon", "ray_traced") not in names


def test_a_page_is_told_its_first_figure_and_every_method_s_kind(desk):
    assert targets.front(desk) == "figure_front" and targets.front(layout_of("claims")) is None
    told = targets.page_arguments(desk)
    assert told["data"]["figure_front"] == "beyond"
    assert told["missing"] == {}
    looks = {"Poisson-disk quadtree sampling": "frequency", "No shadow": "no_shadow"}
    assert looks.items() <= told["kinds"].items()


def test_a_page_is_made_of_the_frames_of_soft_shadows_that_figures_show(desk):
    made, told = targets.page_files(desk), targets.page_arguments(desk)["soft_pictures"]
    assert "results/frames/nsm/room_dragon/test_000.json" in made["soft_parts"]
    assert "results/soft_evaluations/nsm/nsm.npz" in made["soft_answers"]
    assert len(made["soft_answers"]) == len(set(made["soft_answers"]))
    shown = {(one["table"], one["scene"]): one for one in told}
    one = shown["nsm_methods", "room_dragon"]
    assert one["frame_set"] == "nsm" and one["radii"] == [1, 2, 4]
    assert one["labels"]["nsm"] == "Neural Shadow Mapping"
    chosen = layout_of(figures={"figure_nsm_pictures": {"radii": [0, 3]}})
    assert kinds.params(chosen, "figures", "figure_nsm_pictures")["radii"] == [0, 3]


def test_a_page_of_what_is_there(desk, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    assert targets.newest(desk) == 0
    made = tmp_path / "reports" / "table_4_1.json"
    made.parent.mkdir()
    made.touch()
    told = targets.available_arguments(desk)
    assert told["tables"] == ["reports/table_4_1.json"]
    assert told["viewers"] == [] and "viewer.html" in told["missing"]["found"]
    assert "figure_front.svg" in told["missing"]["found"]
    assert "table_4_1.json" not in told["missing"]["tables"] and told["missing"]["compare"]
    assert not {*told["missing"]["figures"]} & {*told["missing"]["extensions"]}
    # The second viewer is shown where the first is not there.
    second = f"reports/{[*desk.settings['viewers']][1]}.html"
    (tmp_path / second).touch()
    assert targets.available_arguments(desk)["viewers"] == [second]
    (tmp_path / second).unlink()
    assert told["figures"] == told["claims_json"] == told["lpips_json"] == []
    assert targets.newest(desk) == made.stat().st_mtime


def test_the_words_at_the_end(desk, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "20")
    (tmp_path / "reports").mkdir()
    (tmp_path / "reports" / "a.md").write_text("| a row that is too wide |\n\n- a note\n")
    made = ["results/lpips.json", "reports/a.csv", "reports/a.md", "reports/figure_1.png"]
    opened = "Open reports/a.md, reports/figure_1.png"
    assert targets.closing_words(desk, made) == f"| a row that is too…\n{opened}"
    assert targets.closing_words(desk, made[:1]) == ""


def test_claims_on_networks_have_what_learns_nothing_on_their_frames(desk):
    """And of networks of kernels what each begins with."""
    measured = claims.files(desk)["soft_metrics"]
    for frame_set, names in {
        "nsm": ("no_shadow", "all_dark", "hard"),
        "windows": ("no_shadow", "all_dark", "hard", "base_msm", "base_hard", "base_pcf"),
    }.items():
        for name in names:
            assert desk.paths.soft_evaluation("csv", frame_set, name) in measured
    bases = desk.settings["claims"]["kpnsm_moments_are_the_best_base"]["bases"]
    assert bases == {"kpnsm": "base_msm", "kpnsm_basic": "base_hard", "kpnsm_pcf": "base_pcf"}
