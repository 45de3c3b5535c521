"""Where files lie, which part a job does, what a table is made of, and what is there by default."""

from dataclasses import replace

import pytest
from shipped import shipped

from neural_shadows.config.reading import read_config
from neural_shadows.config.resolved import resolved
from neural_shadows.errors import InputError
from neural_shadows.evaluation.registry import UNLEARNED
from neural_shadows.layout import evaluations, frame_methods, frame_sets, kinds, tables, trainings
from neural_shadows.layout.layout import Layout
from neural_shadows.layout.parts import HELD_OUT, batches, part_range, view_range
from neural_shadows.layout.paths import ALL
from neural_shadows.layout.shown_meshes import shown_meshes
from neural_shadows.reports import targets
from neural_shadows.reports.claims import inputs as claims
from neural_shadows.reports.page import inputs as pages
from neural_shadows.reports.runs import inputs as runs
from neural_shadows.sections.frame_sets import VIEWS
from neural_shadows.sections.views import Views


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


def test_sequences_are_of_the_first_scene_or_of_those_named(desk):
    parts = frame_sets.sequences(desk, "frames")
    assert {part.split("/")[-2] for part in parts} == {"room_dragon"} and len(parts) == 4
    parts = frame_sets.sequences(desk, "windows")
    moving = desk.frames("windows")["moving"]
    assert [part.split("/")[-2] for part in parts] == [name for name in moving for _ in range(4)]


def test_constants_are_also_chosen_on_other_frames(desk):
    """Of each scene of these the first part, with its generator; and nothing is tested there."""
    files = evaluations.tuned_files(desk, "windows", ALL, "pcss")
    own, others = [], []
    for part in files["frames"]:
        (own if "/windows/" in part else others).append(part.split("/")[-2:])
    assert own == [[scene, "validation_000.json"] for scene in desk.frames("windows")["scenes"]]
    assert others == [[scene, "validation_000.json"] for scene in desk.frames("layouts")["scenes"]]
    tested = evaluations.evaluated_files(desk, "windows", ALL, "pcss")
    assert not any("/layouts/" in part for part in tested["frames"])
    modules = [
        evaluations.modules(desk, kind, "windows", ["pcss"]) for kind in ("tune", "evaluate")
    ]
    grove = [any(module.stem == "grove" for module in each) for each in modules]
    assert grove == [True, False]


def test_parts_follow_each_other():
    assert [part_range(25, 3, part) for part in range(3)] == [(0, 8), (8, 16), (16, 25)]
    views = Views(width=64, height=64, views_per_set=25, batch=12, held_out_views=8)
    assert batches(views) == ["000", "001", "002"]
    ranges = [view_range(views, batch) for batch in [*batches(views), HELD_OUT]]
    assert ranges == [(0, 12), (12, 24), (24, 25), (25, 33)]


def test_sources_of_meshes_and_folders_of_scales():
    mesh = {"generate": None, "path": "meshes/mine.ply"}
    layout = layout_of(scenes={"fence": {"mesh": mesh}}, dragon="stanford")
    assert layout.mesh_source("dragon") == "results/scenes/dragon/source.ply"
    assert layout.mesh_source("fence") == "meshes/mine.ply"
    assert layout.mesh_source("landscape") == "results/scenes/landscape/source.ply"
    assert layout_of("smoke").paths.report("table.csv") == "reports/smoke/table.csv"


def test_files_of_a_training(desk):
    thesis, field = (trainings.files(desk, name) for name in ("dragon", "dragon_field"))
    assert thesis["rays_json"] == "results/rays/dragon/poisson_quadtree/rays.json"
    # An edited mesh of a network that needs none reaches it through its rays.
    assert thesis["mesh_ply"] == [] and field["mesh_ply"] == ["results/scenes/dragon/mesh.ply"]
    shards = [f"results/rays/dragon/poisson_quadtree/bounds.{i:03d}.npy" for i in range(4)]
    assert thesis["bounds"] == shards
    # One that is only built is made of no rays: a stage is told so by the same names.
    built = {**desk.settings["experiments"]["dragon_field"], "sampling": None, "training": None}
    layout = Layout({**desk.settings, "experiments": {"built": built}})
    made = trainings.files(layout, "built")
    assert made["mesh_ply"] == field["mesh_ply"] and made.keys() == field.keys()
    assert made["origins"] == made["bounds"] == made["directions_npy"] == made["rays_json"] == []


def test_files_of_methods(desk):
    assert desk.fixed_bias("shadow_map_512") == desk.fixed_bias("dragon") == 0
    assert desk.bias_file("dragon", "dragon") == desk.bias_file("dragon", "shadow_map_512") == []
    for method in ("shadow_map_512", "shadow_map_pcf_512_biased", "no_shadow"):
        assert desk.weights(method) == []
    assert desk.weights("dragon_biased") == ["results/networks/dragon/weights.safetensors"]
    for method in ("dragon_biased", "dragon_field", "shadow_map_512_biased"):
        name = method.removesuffix("_biased")
        found = [f"results/constants/views/dragon/{name}.json"]
        assert desk.bias_file("dragon", method) == found
        if name != "shadow_map_512":
            assert desk.export_files(name)["depth_bias_json"] == desk.bias_file("dragon", name)


def test_what_reserves_a_gpu(desk):
    """Networks that compute on one: what is only built trains nothing, and a mesh asks Embree."""
    methods = ["dragon_biased", "dragon_distances_256", "dragon_mesh_biased", "shadow_map_512"]
    assert [desk.can_use_gpu(method) for method in methods] == [True, True, False, False]
    trained = [desk.is_trained(name) for name in ("dragon", "dragon_distances_256", "dragon_mesh")]
    assert trained == [True, False, False]
    assert evaluations.on_views(desk, "table_4_4") and not evaluations.on_views(desk, "soft_sun")


@pytest.mark.parametrize(
    ("frame_set", "group"),
    [(VIEWS, "all"), (VIEWS, "dragon"), (VIEWS, "room_dragon.000"), ("frames", "dragon")],
)
def test_groups_of_other_frames_are_refused(desk, frame_set, group):
    with pytest.raises(InputError, match=f"frame_sets.{frame_set}: group '{group}'.* among"):
        evaluations.evaluated_files(desk, frame_set, group, "no_shadow")
    with pytest.raises(InputError, match="frame_sets: 'views' has no `path`"):
        frame_sets.tests(desk, VIEWS)


def test_violations_are_counted_for_the_claims_about_them():
    claim = {"kind": "violations", "methods": ["fence"], "section": "5.1", "statement": "so"}
    layout = layout_of("claims", claims={"lower_bound_costs_more": claim})
    points = layout.settings["learning_curves"]["fence"]
    shortest, longest = (points[k]["experiment"] for k in (0, -1))
    metrics = claims.files(layout)["metrics"]
    counted = {path.rsplit("/", 1)[1] for path in metrics if "/violations/" in path}
    assert {"fence.000.csv", f"{longest}.000.csv"} <= counted and len(counted) == 3  # of its seeds
    assert any(f"/{shortest}." in path for path in metrics)  # whose pictures show how it learns


def test_files_that_methods_are_evaluated_from(desk):
    """Networks from their weights, whatever their bias; others from the mesh."""
    network = evaluations.evaluated_files(desk, VIEWS, "dragon.000", "dragon_biased")
    assert network["weights"] == ["results/networks/dragon/weights.safetensors"]
    assert network["constants_json"] == ["results/constants/views/dragon/dragon.json"]
    assert network["meshes"] == []
    for method, bias in {"shadow_map_512_biased": "shadow_map_512", "no_shadow": None}.items():
        files = evaluations.evaluated_files(desk, VIEWS, "dragon.000", method)
        assert files["weights"] == [] and files["meshes"] == ["results/scenes/dragon/mesh.ply"]
        found = [f"results/constants/views/dragon/{bias}.json"] if bias else []
        assert files["constants_json"] == found


def test_null_predictors_are_measured_by_occluder_where_a_table_is(desk):
    """The claims on several objects before a light had none to be held to."""
    for method in (*UNLEARNED, "nsm"):
        assert frame_methods.occluders(desk, "nsm", method), method
    assert frame_methods.occluders(desk, "windows", "no_shadow") == []
    assert frame_methods.occluders(desk, "nsm", "pcss") == []


def test_a_change_of_one_kind_of_frames_is_none_of_the_other(desk):
    """Nor of methods: each job has the modules of its own."""
    of_views = evaluations.modules(desk, "evaluate", VIEWS, ["shadow_map_64", "dragon"])
    names = {"views", "view_metrics", "shadow_map", "frequency"}
    assert {path.stem for path in of_views} == names
    tuned = evaluations.modules(desk, "tune", VIEWS, ["dragon_biased", "shadow_map_64"])
    assert {path.stem for path in tuned} == {"views", "frequency", "shadow_map"}
    of_frames = evaluations.modules(desk, "evaluate", "frames", ["pcss"])
    scenes = frame_sets.generators(desk, "frames")
    names = {"measured_frames", "frame_metrics", "pcss", "sphere"}
    assert {path.stem for path in of_frames - scenes} == names and len(scenes) > 9
    # Of a filter over time a sequence is measured, too.
    of_history = evaluations.modules(desk, "tune", "frames", ["rt_1_svgf"]) - scenes
    assert {path.stem for path in of_history} == {
        "measured_frames",
        "sequences",
        "denoised",
        "sphere",
    }
    of_network = evaluations.modules(desk, "tune", "windows", ["kpnsm"])
    assert {"kernels", "screen_network_method"} < {path.stem for path in of_network}


def test_filters_over_time_have_sequences_of_their_own_for_their_constants(desk):
    """One of each scene that networks train on, and of each motion."""
    files = {
        name: evaluations.tuned_files(desk, "frames", "all", name)["sequences"]
        for name in ("rt_1_svgf", "rt_1_oidn", "pcss")
    }
    sequences = files.pop("rt_1_svgf")
    parts = "both", "camera", "light", "object", "both"
    scenes = "room_dragon", "atrium", "hall", "classroom", "gallery"
    assert sequences == [
        f"results/frames/frames/{scene}/validation_{part}_000.json"
        for scene, part in zip(scenes, parts)
    ]
    assert not {*sequences} & {
        *evaluations.evaluated_files(desk, "frames", "all", "pcss")["sequences"]
    }
    assert set(map(tuple, files.values())) == {()}
    of_one_scene = evaluations.tuned_files(desk, "nsm", "all", "rt_4_ffx")["sequences"]
    assert of_one_scene == [
        f"results/frames/nsm/room/validation_{part}_000.json" for part in parts[:4]
    ]
    settings = frame_sets.frame_settings(desk, "room_dragon", "frames", "validation_both_000")
    assert settings["last"] == 5 and settings["samples"] == 4


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
    last = frame_sets.frame_settings(layout, "tree", "windows", "test_001")["last"]
    assert last == 20


def test_other_twins_render_training_frames_alone_anew(desk):
    other = layout_of(frame_sets={"nsm": {"twins": {"count": 7}}})
    parts = ("train_000", "validation_000", "test_000", "camera_000")
    settings = [
        [frame_sets.frame_settings(layout, "room", "nsm", part) for part in parts]
        for layout in (desk, other)
    ]
    assert [a == b for a, b in zip(*settings)] == [False, True, True, True]


def test_times_are_of_a_scene_that_is_trained_on_and_of_one_unseen(desk):
    """More rays cost more where more stands in their way."""
    (seen, unseen) = evaluations.timed_files(desk, "shipped_methods", "all")["frames"]
    scenes = [path.split("/")[-2] for path in (seen, unseen)]
    assert [scene in desk.frames("windows")["unseen"] for scene in scenes] == [False, True]


def test_steps_are_measured_in_their_number_formats(desk):
    made = kinds.table_files(desk, "nsm_steps")
    measured = [*made["soft_metrics"], *made["null_metrics"]]
    assert [path.rsplit("/", 1)[1] for path in measured] == [
        *("nsm_trimmed_float32.csv", "nsm_trimmed_bfloat16.csv", "nsm_bfloat16.csv"),
        *("no_shadow.csv", "all_dark.csv", "hard.csv"),  # what learns nothing
    ]
    method = "nsm_trimmed_float32"
    assert frame_methods.precision(desk, method) == "float32"
    assert frame_methods.weights(desk, method) == frame_methods.weights(desk, "nsm_trimmed")
    assert frame_methods.precision(desk, "nsm_trimmed") == "auto"


def test_networks_are_timed_in_the_formats_that_tables_show(desk):
    """And level by level, in all formats, where one shows levels, or if none names them."""
    formats = {name: tables.profiled_formats(desk, name) for name in ("original", "kpnsm")}
    assert formats == {"original": ["float32"], "kpnsm": ["bfloat16"]}
    assert tables.profiled_formats(desk, "trimmed") is None
    assert tables.profiled_formats(desk, "kpnsm_pcf") is None


def test_a_network_for_each_scene_is_by_scene(desk):
    methods = ("kpnsm_nsm_single", "kpnsm_nsm_joint", "pcss")
    assert [frame_methods.by_scene(desk, one) for one in methods] == [True, False, False]


def test_tables_and_claims_are_made_of_their_rows(desk):
    made = kinds.table_files(desk, "table_4_3")
    assert "results/evaluations/views/dragon.001/shadow_map_512.csv" in made["metrics"]
    networks = ["dragon", "dragon_field"]
    assert made["trainings"] == [f"results/networks/{name}/training.json" for name in networks]
    assert made["depth_biases"] == ["results/constants/views/dragon/dragon_field.json"]
    assert "results/evaluations/views/dragon.000/all_dark.csv" in made["metrics"]
    assert "reports/scenes/dragon.png" in made["beside"]
    # An edited network's code leaves a table alone that reads none of its files.
    read = [kinds.modules(desk, "tables", name) for name in ("table_4_3", "table_4_7")]
    assert ["frequency" in {path.stem for path in modules} for modules in read] == [False, True]
    judged = claims.files(desk)
    assert "results/networks/dragon_high_rate/loss.csv" in judged["losses"]
    # Not timed, but in a pair: its record says how long it was trained.
    assert "results/networks/landscape_axis_128/training.json" in judged["trainings"]
    for scene in ("dragon", "fence", "landscape"):
        assert f"results/evaluations/views/{scene}.000/no_shadow.csv" in judged["metrics"]
        assert f"results/scenes/{scene}/mesh.json" in judged["meshes"]
    assert judged["published_csv"] == "config/published.csv"
    assert claims.arguments(desk)["learning_curves"] == {}
    with pytest.raises(InputError, match="tables: .*did you mean 'table_4_3'"):
        kinds.table_files(desk, "table_4_33")


def test_an_argument_of_no_file_and_no_setting_is_refused(desk, monkeypatch):
    def table(soft_metric, more_metrics=()):
        return soft_metric, more_metrics

    monkeypatch.setattr(kinds.kind_of(desk, "tables", "table_4_3"), "table", table)
    message = r"tables.table_4_3: argument 'soft_metric' \(did you mean 'soft_metrics'\?\)"
    with pytest.raises(InputError, match=f"{message}.*of reports/tables/comparison.py return it"):
        kinds.table_files(desk, "table_4_3")


@pytest.mark.parametrize("name", ["kpnsm_forty_rays_are_better", "kpnsm_rays_at_equal_time"])
def test_claims_on_networks_of_frames_read_all_their_trainings(name):
    layout = layout_of("kpnsm_seeds")
    layout.settings["claims"] = {name: layout.settings["claims"][name]}
    judged = claims.files(layout)
    for network in ("kpnsm", "kpnsm_seed_1", "kpnsm_basic_seed_2"):
        record = f"results/networks/{network}/training.json"
        assert record in judged["screen_trainings"]
        assert layout.paths.evaluation("csv", "windows", network, ALL) in judged["soft_metrics"]


def test_files_of_learning_curves():
    layout = layout_of("claims")
    names = [point["experiment"] for point in layout.settings["learning_curves"]["dragon_uniform"]]
    assert len(names) == 15 and names[-3] == "dragon_uniform"
    made, judged = kinds.table_files(layout, "learning_sampling"), claims.files(layout)
    for found in (made, judged):
        for name in names:
            assert f"results/claims/evaluations/views/dragon.000/{name}.csv" in found["metrics"]
            assert f"results/claims/networks/{name}/training.json" in found["trainings"]
        assert "results/claims/evaluations/views/dragon.000/no_shadow.csv" in found["metrics"]
    for name in names:
        assert f"results/claims/networks/{name}/loss.csv" in made["losses"]
    told = kinds.params(layout, "tables", "learning_sampling")
    assert [*told["curves"]] == [row["method"] for row in told["rows"]]
    assert [*told["curves"]] == ["dragon", "dragon_uniform_quadtree", "dragon_uniform"]
    assert "fence" in claims.arguments(layout)["learning_curves"]
    biased = {**told["rows"][0], "method": "dragon_biased"}
    methods = [row["method"] for row in tables.with_curves(layout, [biased])]
    assert methods[:2] == ["dragon_biased", "dragon_500_steps_seed_2026_biased"]


def test_files_of_learning_curves_over_frames():
    layout = layout_of("layout_curves")
    point = "kernels_pcf_64_frames_600_steps_seed_2027"
    made = kinds.table_files(layout, "learning_layouts")
    assert len(made["trainings"]) == 4 * 3 * 3
    assert f"results/retrain/networks/{point}/training.json" in made["trainings"]
    assert not {"metrics", "meshes", "lpips_json"} & {*made}
    rows = kinds.params(layout, "figures", "figure_learning_layouts")["rows"]
    assert [row["steps"] for row in rows] == [600] * 4
    assert rows[0]["label"].endswith("84 layouts, 600 steps") and rows[0]["scene"] == "layouts"
    # The first files of each scene to train on, and all to validate.
    files, whole = (trainings.files(layout, name) for name in (point, "kernels_pcf"))
    assert len(files["train"]) == 12 * 4 and len(whole["train"]) == 12 * 7
    assert files["train"][:4] == whole["train"][:4] and files["train"][4] == whole["train"][7]
    assert files["validation"] == whole["validation"]
    assert trainings.settings(layout, point)["training"]["steps"] == 600


def test_shipped_weights_need_no_training():
    """A file of the working directory or the checkout, or a URL; and null trains."""
    digest = {"sha256": "0" * 64}
    entries = {
        "kpnsm": {"weights": {"path": "README.md", **digest}},
        "kpnsm_basic": {"weights": {"path": "https://example.org/it.safetensors", **digest}},
    }
    layout = replace(layout_of(experiments=entries), root="checkout")
    assert {"kpnsm", "kpnsm_basic"} <= {*trainings.restored(layout)}
    assert trainings.shipped_file(layout, "kpnsm") == ["README.md"]
    assert trainings.shipped_file(layout, "kpnsm_basic") == []
    network = layout.settings["experiments"]["kpnsm"]["network"]
    assert trainings.restored_settings(layout, "kpnsm") == {
        **entries["kpnsm"]["weights"],
        "network": network,
    }
    entries["kpnsm"]["weights"]["path"] = "elsewhere.safetensors"
    layout = replace(layout_of(experiments=entries), root="checkout")
    assert trainings.shipped_file(layout, "kpnsm") == ["checkout/elsewhere.safetensors"]
    entries["kpnsm"]["weights"] = None
    assert "kpnsm" not in trainings.restored(layout_of(experiments=entries))


def test_durations_are_of_what_comes_before_a_training(desk):
    durations = kinds.params(desk, "tables", "beyond")["durations"]
    told = durations["landscape_field_axis"]
    assert told[:2] == [
        "results/benchmarks/prepare_mesh/landscape.tsv",
        "results/benchmarks/draw_directions/landscape.single_axis.tsv",
    ]
    assert told[-1] == "results/benchmarks/sample_rays/landscape.single_axis.003.tsv"
    assert len(told) == 2 + 4
    # What is only built needs no rays.
    assert durations["dragon_mesh"] == ["results/benchmarks/prepare_mesh/dragon.tsv"]


def test_pictures_are_judged_by_all_views_and_by_no_shadow(desk):
    made = kinds.files(desk, "figures", "figure_4_4")
    groups = [f"results/evaluations/views/dragon.{part}" for part in ("000", "001")]
    for method in ("dragon", "no_shadow"):
        assert {f"{group}/{method}.csv" for group in groups} <= {*made["metrics"]}
    assert {f"{group}/dragon.npz" for group in groups} <= {*made["visibilities"]}
    assert f"{groups[0]}/no_shadow.npz" not in made["visibilities"]


def test_losses_come_with_what_became_of_their_trainings(desk):
    made = kinds.files(desk, "figures", "figure_4_1")
    for name, file in {"losses": "loss.csv", "trainings": "training.json"}.items():
        assert f"results/networks/dragon/{file}" in made[name]


def test_what_is_made_by_default(desk):
    reports = targets.all_reports(desk)
    assert {"reports/table_4_3.csv", "reports/index.html", "reports/claims.md"} <= {*reports}
    assert not any("ablations" in path or "figure_3d" in path for path in reports)
    names = [(row["scene"], row["method"]) for row in pages.pictured(desk)]
    assert len(names) == len(set(names)) and ("dragon", "ray_traced") not in names


def test_a_page_is_told_its_questions_and_every_method_s_kind(desk):
    told = pages.page_arguments(desk)
    assert len(told["questions"]) == 7
    bytes_stored = {"claim": "coded_mesh_better_than_field", "figure": "figure_stored"}
    assert any(bytes_stored.items() <= one.items() for one in told["questions"])
    assert told["data"]["figure_front"] == "beyond"
    assert told["missing"] == []
    looks = {"Poisson-disk quadtree sampling": "frequency", "No shadow": "no_shadow"}
    assert looks.items() <= told["kinds"].items()


def test_a_figure_has_its_table_s_chapter_but_for_quality_over_costs(desk):
    of = pages.chapters(desk)
    expected = {
        **{"figure_4_4": "thesis", "figure_3_1": "thesis", "figure_stored": "costs"},
        **{"soft_methods": "soft", "figure_soft_pictures": "soft", "kpnsm_table_1": "networks"},
        **{"kpnsm_equal_time": "networks", "figure_kpnsm_equal_time": "costs"},
    }
    assert expected.items() <= of.items()


def test_a_page_is_made_of_the_frames_of_soft_shadows_that_figures_show(desk):
    made, told = pages.page_files(desk), pages.page_arguments(desk)["soft_pictures"]
    assert "results/frames/nsm/room_dragon/test_000.json" in made["soft_parts"]
    assert "results/evaluations/nsm/all/nsm.npz" in made["soft_answers"]
    assert len(made["soft_answers"]) == len(set(made["soft_answers"]))
    shown = {(one["table"], one["scene"]): one for one in told}
    one = shown["nsm_methods", "room_dragon"]
    assert one["frame_set"] == "nsm" and one["radii"] == [0, 2, 4]
    assert one["labels"]["nsm"] == "Neural Shadow Mapping"


def test_a_page_of_what_is_there(desk, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    assert pages.newest(desk, "available") == 0
    made = tmp_path / "reports" / "table_4_1.json"
    made.parent.mkdir()
    made.touch()
    told = pages.page_settings(desk, "available")
    assert told["tables"] == ["reports/table_4_1.json"]
    assert told["viewers"] == [] and {"viewer", "figure_front"} <= {*told["missing"]}
    assert "table_4_1" not in told["missing"]
    assert not any("frames of" in name for name in told["missing"])  # no reference is rendered
    # The second viewer is shown where the first is not there.
    second = f"reports/{[*desk.settings['viewers']][1]}.html"
    (tmp_path / second).touch()
    assert pages.page_settings(desk, "available")["viewers"] == [second]
    (tmp_path / second).unlink()
    assert told["figures"] == told["claims_json"] == told["lpips_json"] == []
    assert pages.newest(desk, "available") == made.stat().st_mtime


def test_a_manifest_lists_default_reports_and_those_on_request_that_are_there(
    desk, monkeypatch, tmp_path
):
    monkeypatch.chdir(tmp_path)
    ablations = tmp_path / "reports" / "ablations.csv"
    default = {*runs.files(desk)["reports"]}
    assert {"reports/index.html", "reports/table_4_3.csv", "reports/viewer.png"} < default
    assert runs.on_request(desk) == {} and "reports/ablations.csv" not in default
    ablations.parent.mkdir()
    for path in (
        ablations,
        tmp_path / "reports" / "table_4_3.csv",
        tmp_path / "reports" / "my.csv",
    ):
        path.touch()
    assert runs.on_request(desk) == {"reports/ablations.csv": ablations.stat().st_mtime}


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
            assert desk.paths.evaluation("csv", frame_set, name, ALL) in measured
    bases = desk.settings["claims"]["kpnsm_moments_are_the_best_base"]["bases"]
    assert bases == {"kpnsm": "base_msm", "kpnsm_basic": "base_hard", "kpnsm_pcf": "base_pcf"}


def test_meshes_that_no_report_shows_are_left_out(desk):
    assert shown_meshes(desk) == desk.mesh_scenes
    entries = desk.settings["tables"], desk.settings["scenes"]
    soft = {"soft_sun": entries[0]["soft_sun"]}
    alone = Layout(
        {**desk.settings, "tables": soft, "figures": {}, "viewers": {}, "claims": {}},
    )
    assert shown_meshes(alone) == ["dragon", "fence"]  # stand in the frames of `sun`
    pictures = [path for path in targets.all_reports(alone) if "/scenes/" in path]
    assert {path.split("/")[-1] for path in pictures} == {
        f"{name}.{ending}" for name in ("dragon", "fence") for ending in ("png", "svg")
    }
