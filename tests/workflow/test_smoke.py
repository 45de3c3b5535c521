"""One run of the smoke workflow makes every report; test_reruns.py has a second that does nothing."""

import json
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import onnxruntime
import pandas as pd
from checkout import SECRET
from PIL import Image
from shipped import DEFAULT

from neural_shadows.evaluation.registry import available
from neural_shadows.reports.drawing import opengl

METRICS = ["psnr", "ssim", "flip", "shadow_error", "false_shadow", "light_leak"]


def test_everything_is_made_and_nothing_else_is_left(smoke):
    names = [f"table_4_{n}.{ending}" for n in (3, 6, 7) for ending in ("csv", "md")]
    figures = [f"3_{n}" for n in range(1, 7)] + [f"4_{n}" for n in (1, 4, 8)]
    figures += ["front", "beyond_slice", "learning_sampling", "views_dragon"]
    figures += ["soft_equal_time", "soft_pictures", "soft_penumbrae", "kpnsm_radii"]
    names += [f"figure_{name}.{ending}" for name in figures for ending in ("png", "svg")]
    names += [
        "claims.csv",
        "claims.md",
        "index.html",
        "viewer.html",
        "viewer.png",
        "beyond.csv",
        "beyond.md",
    ]
    names += ["learning_sampling.csv", "learning_sampling.md"]
    soft = ("soft_methods", "soft_sun")
    soft += tuple(f"kpnsm_table_{n}" for n in (1, 3))
    soft += ("kpnsm_unseen", "kpnsm_radii", "kpnsm_penumbrae")
    names += [f"{name}.{ending}" for name in soft for ending in ("csv", "md")]
    scenes = ("dragon", "landscape")  # the fence is in no report of smoke
    names += [f"scenes/{name}.{ending}" for name in scenes for ending in ("png", "svg")]
    for name in names:
        assert (smoke.reports / name).stat().st_size > 0, name
    left = [path for path in smoke.folder.glob("re*/**/*") if path.name.startswith(".")]
    assert left == []
    assert list(smoke.results.glob("networks/checkpoints/*")) == []
    said = (smoke.folder / "said").read_text(encoding="utf-8")
    assert "Open reports/smoke/index.html" in said


def test_no_secret_is_written_and_no_folder_reported(smoke):
    for path in smoke.folder.glob("re*/**/*"):
        if path.is_file():
            content = path.read_bytes()
            assert SECRET.encode() not in content, path
            if smoke.reports in path.parents:
                assert str(smoke.folder).encode() not in content, path
                assert str(Path.home() / ".cache").encode() not in content, path


def test_values_are_finite_and_within_their_intervals(smoke):
    table = pd.read_csv(smoke.reports / "table_4_3.csv")
    assert {"512² shadow map", "No shadow"} < set(table["method"])
    assert len(table) == 5
    for metric in METRICS:
        low, mean, high = (table[f"{metric}{ending}"] for ending in ("_low", "", "_high"))
        assert np.isfinite([low, mean, high]).all(), metric
        assert ((low <= mean) & (mean <= high)).all(), metric
    errors = table["false_shadow"] + table["light_leak"]
    assert np.allclose(errors, table["shadow_error"], atol=1e-6)
    assert (table["views"] == 6).all()  # 2 sets of 3
    # Without its trunk, LPIPS is left out.
    names = [name for name in table.columns if name.startswith("lpips")]
    assert names and table[names].isna().all(axis=None)
    text = (smoke.reports / "table_4_3.md").read_text(encoding="utf-8")
    assert "LPIPS" in text and "wyrm" in text and "120 × 80" in text


def test_every_kind_of_network_is_in_the_table_past_the_thesis(smoke):
    table = pd.read_csv(smoke.reports / "beyond.csv")
    assert set(table["scene"]) == {"dragon", "landscape"}
    networks = table[table["encoding"].notna()]
    kinds = {"frequency", "ray_grid", "occupancy_ray_grid", "hash_grid", "occupancy_field"}
    built = {"mesh", "voxel_dag", "height_map"}
    assert set(networks["encoding"]) == kinds | built
    measured = ["stored_bytes", "parameters", "build_seconds", "depth_bias", "own_ms", "psnr"]
    assert np.isfinite(networks[measured]).all(axis=None)


def test_soft_methods_are_measured(smoke):
    whole, sun = (
        pd.read_csv(smoke.reports / f"{name}.csv").set_index(["method", "number"])
        for name in ("soft_methods", "soft_sun")
    )
    filters = ["rt_4_svgf", "rt_1_ffx", "rt_1_sigma_ffx", "rt_1_oidn"]
    asked = ["pcss", "msm_9", "rt_1", *filter(available, filters)]
    assert {*whole.index.unique(0)} == {*asked, "no_shadow", "all_dark"}
    assert np.isfinite(whole[["mse", "ssim"]]).all(axis=None)
    assert np.isfinite(whole.loc[asked, "ms"]).all()
    middle = whole.xs(1, level=1)  # of the two lights
    assert np.isfinite(middle[["flip", "instability_camera", "instability_object"]]).all(axis=None)
    assert set(sun["unit"]) == {"°"} and set(whole["unit"]) == {"m"}
    assert np.isfinite(sun.loc["pcss", ["mse", "ms"]]).all(axis=None)


def test_networks_of_kernels_stand_beside_printed_numbers(smoke):
    table = pd.read_csv(smoke.reports / "kpnsm_table_1.csv").set_index("method")
    networks = ["kpnsm", "kpnsm_nsm_single"]
    measured = ["mse", "ssim", "time", "printed_mse", "printed_ssim", "printed_time"]
    assert np.isfinite(table.loc[networks, measured]).all(axis=None)
    calm = pd.read_csv(smoke.reports / "kpnsm_table_3.csv")
    assert np.isfinite(calm[["temporal_error", "printed_temporal_error"]]).all(axis=None)
    unseen = pd.read_csv(smoke.reports / "kpnsm_unseen.csv")
    assert set(unseen["scene"]) == {"blinds"} and np.isfinite(unseen["mse"]).all()


def test_no_figure_is_blank_or_large(smoke):
    kinds_3d = ("scene", "field", "errors", "depths")
    names = [f"figure_3d_{kind}" for kind in kinds_3d if opengl.available()]
    figures = {path.stem: path for path in smoke.reports.glob("figure_*.png")}
    assert {*names} <= figures.keys()
    for name, path in figures.items():
        assert np.asarray(Image.open(path).convert("L")).std() > 12, name  # 31 and more
        largest = 2_000_000 if name in names else 600_000
        assert path.with_suffix(".svg").stat().st_size < largest, name


def test_a_page_of_all(smoke):
    page = (smoke.reports / "index.html").read_text(encoding="utf-8")
    assert 'id="table-table_4_3"' in page and 'id="figure-figure_beyond_slice"' in page
    assert "<script src" not in page and "<link" not in page


def test_a_network_is_exported(finished):
    finished.run("results/smoke/networks/dragon_field/network.onnx")
    folder = finished.results / "networks" / "dragon_field"
    conventions = json.loads((folder / "network.json").read_text(encoding="utf-8"))
    assert conventions["query"]["depth_bias"] > 0
    assert onnxruntime.InferenceSession(folder / "network.onnx").get_outputs()


def test_snakemake_reports_the_run(smoke, tmp_path):
    assert "Report created" in smoke.run("--report", str(tmp_path / "report.zip"))


def test_the_workflow_is_a_module_of_another(fresh, tmp_path):
    """As `snakedeploy` sets it up: the configuration is the user's, in a folder of their own."""
    shutil.copytree(fresh.folder / "config", tmp_path / "config")
    (tmp_path / "Snakefile").write_text(
        "".join(f'configfile: "config/{name}.yaml"\n' for name in (*DEFAULT, "smoke"))
        + "module shadows:\n"
        f'    snakefile: "{fresh.folder}/workflow/Snakefile"\n'
        "    config: config\n"
        "use rule * from shadows\n"
    )
    said = replace(fresh, folder=tmp_path).run("--dry-run")
    assert "Writing table_4_3" in said and "everything" in said
