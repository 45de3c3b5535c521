"""One run of the smoke workflow makes every report, and a second does nothing."""

import json
import xml.etree.ElementTree
from pathlib import Path

import numpy as np
import onnxruntime
import pandas as pd
import pytest
from checkout import SECRET
from PIL import Image

MAPS = ["2048² shadow map", "1024² shadow map", "512² shadow map", "256² shadow map"]
OURS = "256³ occupancy field (this project's)"
METRICS = ["psnr", "ssim", "flip", "shadow_error", "false_shadow", "light_leak"]


@pytest.fixture(scope="module")
def table(smoke) -> pd.DataFrame:
    return pd.read_csv(smoke.reports / "table_4_3.csv")


def test_second_run_does_nothing(smoke):
    said = smoke.run()
    assert "Nothing to be done" in said
    assert "Execute" not in said


def test_everything_is_made_and_nothing_else_is_left(smoke):
    names = [f"table_4_{n}.{ending}" for n in range(1, 8) for ending in ("csv", "md")]
    figures = [f"3_{n}" for n in range(1, 7)] + [f"4_{n}" for n in range(1, 9)]
    names += [f"figure_{number}.{ending}" for number in figures for ending in ("png", "svg")]
    beyond = ("dragon", "fence", "landscape", "slice", "pictures_landscape")
    names += [f"figure_beyond_{part}.{ending}" for part in beyond for ending in ("png", "svg")]
    names += ["claims.csv", "claims.md", "index.html", "beyond.csv", "beyond.md"]
    for name in names:
        assert (smoke.reports / name).stat().st_size > 0, name
    parts = [path for path in smoke.folder.glob("re*/**/*") if ".part" in path.name]
    assert parts == []
    assert list(smoke.results.glob("networks/unfinished/*")) == []


def test_each_job_left_its_log(smoke):
    logs = {row["log-file(s)"] for row in smoke.summary()}
    assert len(logs) == 140  # one for each job, shards and batches counted
    assert [name for name in logs if not (smoke.folder / name).is_file()] == []
    (training,) = [name for name in logs if name.endswith("/train/dragon.log")]
    assert "train dragon: 100%" in (smoke.folder / training).read_text()


def test_each_log_has_the_record_of_its_job(smoke):
    rates = {}
    for row in smoke.summary():
        log = smoke.folder / row["log-file(s)"]
        (line,) = (said for said in log.read_text().splitlines() if said.startswith("{"))
        record = json.loads(line)
        assert (record["rule"], record["outcome"]) == (row["rule"], "done"), log
        assert row["output_file"] in sum(record["outputs"].values(), [])
        assert record["inputs"]["code"], log
        for file in sum(record["inputs"].values(), []):
            assert file["bytes"] > 0 and len(bytes.fromhex(file["sha256"])) == 32
        rates[record["rule"]] = {rate["unit"] for rate in record["rates"]}
        # The digests that a training logs are those that its rays were described with.
        if record["rule"] == "train":
            (described,) = record["inputs"]["description"]
            shards = json.loads((smoke.folder / described["path"]).read_text())["sha256"]
            assert len(record["inputs"]["origins"]) > 0
            for file in record["inputs"]["origins"] + record["inputs"]["bounds"]:
                assert shards[Path(file["path"]).name] == file["sha256"]
            assert "seed" in record["seeds"]
    counted = {rule: units for rule, units in rates.items() if units}
    assert counted == {
        **dict.fromkeys(("sample_rays", "label_rays", "train"), {"samples"}),
        **dict.fromkeys(("evaluate", "find_depth_biases"), {"views"}),
        "frame_times": {"frames"},
    }


def test_no_secret_is_written_and_no_folder_reported(smoke):
    for path in smoke.folder.glob("re*/**/*"):
        if path.is_file():
            content = path.read_bytes()
            assert SECRET.encode() not in content, path
            if smoke.reports in path.parents:
                assert str(smoke.folder).encode() not in content, path
                assert str(Path.home() / ".cache").encode() not in content, path


def test_columns_and_rows_are_the_thesis_s(table):
    assert list(table.columns[:4]) == ["method", "lpips", "psnr", "ssim"]
    assert sorted(table["method"]) == sorted([*MAPS, "128² shadow map", "Our method", OURS])
    printed = dict(zip(table["method"], table["thesis_psnr"]))
    assert printed["2048² shadow map"] == 38.50
    assert printed["Our method"] == 27.39
    assert np.isnan(printed[OURS])


def test_finer_shadow_maps_are_better(table):
    psnr = table.set_index("method")["psnr"][[*MAPS, "128² shadow map"]]
    assert psnr.is_monotonic_decreasing and psnr.is_unique
    # Of the rows as they are written, too.
    maps = table["method"][~table["method"].isin(["Our method", OURS])]
    assert list(maps) == [*MAPS, "128² shadow map"]


def test_values_are_finite_and_within_their_intervals(table):
    for metric in METRICS:
        low, mean, high = (table[f"{metric}{ending}"] for ending in ("_low", "", "_high"))
        assert np.isfinite([low, mean, high]).all(), metric
        assert ((low <= mean) & (mean <= high)).all(), metric
    assert table["psnr"].between(5, 100).all()
    assert table["ssim"].between(0, 1).all()
    assert np.allclose(
        table["false_shadow"] + table["light_leak"], table["shadow_error"], atol=1e-6
    )
    assert (table["views"] == 6).all()  # 2 sets of 3


def test_lpips_is_empty_without_its_trunk(table):
    names = [name for name in table.columns if name.startswith("lpips")]
    assert set(names) >= {"lpips", "lpips_low", "lpips_high"}
    assert table[names].isna().all(axis=None)


def test_table_says_what_it_is_of(smoke):
    text = (smoke.reports / "table_4_3.md").read_text(encoding="utf-8")
    for part in (
        "Scale: smoke",
        "120 × 80",
        "Mesh: wyrm",
        "200 steps of 1,024 samples",
        "256³ occupancy field (this project's): with a depth bias of 0.",
        "LPIPS is missing",
        "cannot download https://download.pytorch.org/",
    ):
        assert part in text


@pytest.mark.parametrize("name", ["figure_4_4.png", "figure_4_6.png", "scenes/dragon.png"])
def test_pictures_are_pictures(smoke, name):
    with Image.open(smoke.reports / name) as image:
        assert image.format == "PNG"
        assert 600 <= image.width <= 4000 and 300 <= image.height <= 4000
        grey = np.asarray(image.convert("L"), dtype=float)
    assert grey.std() > 10  # not a blank sheet
    assert len(np.unique(grey)) > 50  # shading, not line art alone


def test_each_network_is_trained_once(smoke):
    trained = [path.name for path in smoke.results.glob("networks/*") if path.name != "unfinished"]
    planned = [row["output_file"] for row in smoke.summary() if row["rule"] == "train"]
    assert len(trained) == len({*trained}) == 37
    assert sum(path.endswith("weights.safetensors") for path in planned) == 37


def test_few_views_leave_claims_undecided(smoke):
    claims = pd.read_csv(smoke.reports / "claims.csv").set_index("claim")
    assert len(claims) >= 20
    assert claims.loc["sampling", "verdict"] == "undecided"
    assert "6 values are too few" in claims.loc["sampling", "evidence"]
    assert (claims["scale"] == "smoke").all()


def test_page_shows_every_table_and_figure(smoke):
    page = (smoke.reports / "index.html").read_text(encoding="utf-8")
    for number in range(1, 8):
        assert f'id="table_4_{number}"' in page
    for number in ("3_1", "3_6", "4_1", "4_8"):
        assert f'id="figure_{number}"' in page
    for scene in ("dragon", "fence", "landscape"):
        assert f'id="compare-{scene}"' in page
    assert len(page) < 6_000_000


def test_snakemake_makes_its_own_report(smoke, tmp_path):
    smoke.run("--report", str(tmp_path / "report.html"))
    report = (tmp_path / "report.html").read_text(encoding="utf-8")
    for part in ("Tables", "Figures", "Claims", "Depth of shadow in a slice of the dragon"):
        assert part in report


def test_strip_is_a_vector_file_too(smoke):
    root = xml.etree.ElementTree.parse(smoke.reports / "figure_4_5.svg").getroot()
    assert root.tag == "{http://www.w3.org/2000/svg}svg"


def test_networks_past_the_thesis_are_in_one_table(smoke):
    table = pd.read_csv(smoke.reports / "beyond.csv")
    assert set(table["scene"]) == {"dragon", "fence", "landscape"}
    networks = table[table["encoding"].notna()]
    assert set(networks["encoding"]) == {
        *("frequency", "ray_grid", "occupancy_ray_grid", "hash_grid", "occupancy_field")
    }
    facts = ["bytes", "parameters", "training_seconds", "samples", "depth_bias"]
    assert np.isfinite(networks[[*facts, "rays_per_second", "frame_ms", "psnr", "flip"]]).all(
        axis=None
    )
    unbiased = networks["method"].str.endswith("no bias")
    assert (networks["depth_bias"][unbiased] == 0).all() and unbiased.sum() == 3
    # A field of 20 steps has learned more than the thesis's network in 200, with fewer bytes.
    dragon = table[table["scene"] == "dragon"].set_index("method")
    field, thesis = dragon.loc["256³ occupancy field"], dragon.loc["Thesis's network"]
    assert field["psnr"] > thesis["psnr"] + 3 and field["bytes"] < thesis["bytes"]


def test_page_has_a_part_of_its_own_for_them(smoke):
    page = (smoke.reports / "index.html").read_text(encoding="utf-8")
    start = page.index('<section id="beyond">')
    for name in ("beyond", "figure_beyond_dragon", "figure_beyond_slice"):
        assert page.index(f'<article id="{name}">') > start
    assert 'id="ablations"' not in page


def test_a_network_is_exported(smoke):
    smoke.run("results/smoke/networks/dragon_field/network.onnx")
    folder = smoke.results / "networks" / "dragon_field"
    conventions = json.loads((folder / "network.json").read_text(encoding="utf-8"))
    assert conventions["query"]["depth_bias"] > 0
    assert conventions["sphere"]["radius"] == pytest.approx(1.245, abs=0.05)
    session = onnxruntime.InferenceSession(folder / "network.onnx")
    rays = np.array([[0, 0, 1]], np.float32)
    (t_pred,) = session.run(None, {"origins": rays, "directions": -rays})
    assert 0 < t_pred[0] <= 2
