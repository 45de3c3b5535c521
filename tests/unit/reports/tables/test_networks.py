import numpy as np
import pytest
import report_samples as samples

from neural_shadows.reports.data.quality import METRICS
from neural_shadows.reports.tables.networks import table as make_table

ROWS = [
    samples.row("ray_traced", "Ray traced"),
    samples.row("shadow_map_128", "128²"),
    samples.row("shadow_map_512", "512²"),
    samples.row("mesh_biased", "Mesh", bias="held_out", trained=False),
    samples.row("dragon_biased", "Network", bias="held_out"),
    samples.row("dragon", "Network, no bias"),
    samples.row("no_shadow", "No shadow"),
    samples.row("shadow_map_512", "512²", scene="fence"),
    samples.row("no_shadow", "No shadow", scene="fence"),
]
MEANS = {
    "shadow_map_128": (0.4, 25, 0.8),
    "shadow_map_512": (0.3, 31, 0.9),
    "mesh_biased": (0.05, 42, 0.98),
    "dragon_biased": (0.2, 34, 0.95),
    "dragon": (0.5, 20, 0.7),
    "no_shadow": (0.5, 20, 0.7),
}
BUILT = samples.TRAINING | {"name": "mesh", "network": {"encoding": "mesh"}, "training": None}
BUILT |= {"samples": 0, "seconds": 2.0, "unfit": True}
TIMED = {
    "ray_traced": samples.timed([1, 2, 3]),
    "shadow_map_128": samples.timed([3], resident_bytes=4 * 128**2),
    "shadow_map_512": samples.timed([4], resident_bytes=2**20),
    "mesh_biased": samples.timed([2], resident_bytes=5 * 2**20),
    "dragon_biased": samples.timed([5, 9, 7, 8, 6], [1, 2, 3], resident_bytes=2**22),
    "dragon": samples.timed([1340], [1339.6], resident_bytes=2**22),
    "no_shadow": samples.timed([1]),
}


@pytest.fixture
def written(tmp_path):
    def written(devices=("cpu", "cpu"), **mesh):
        times, metrics = [], []
        for scene, device in zip(("dragon", "fence"), devices):
            rows = [row for row in ROWS if row["scene"] == scene]
            methods = {row["method"]: TIMED[row["method"]] | {"device": device} for row in rows}
            rates = {"dragon_biased": [1e6, 3e6, 2e6], "dragon": [1e6]}
            machine = samples.MACHINE | {"gpu": "a GPU"}
            timed = {**samples.TIMES, "machine": machine, "scene": scene}
            timed |= {"methods": methods, "rays_per_second": rates}
            times.append(samples.write_record(tmp_path / f"frame_times/{scene}.json", timed))
            means = {
                row["method"]: dict.fromkeys(METRICS, 0.1)
                | dict(zip(("lpips", "psnr", "ssim"), MEANS[row["method"]]))
                for row in rows
                if row["method"] != "ray_traced"
            }
            metrics.append(samples.write_metrics(tmp_path, means, scene))
        benchmarks = [tmp_path / f"{name}.tsv" for name in ("mesh", "rays", "never")]
        for path, seconds in zip(benchmarks[:2], (1, 10)):
            path.write_text(f"s\th:m:s\n{seconds}\t-\n")
        biases = {"dragon": (0.01, 0.0, False), "mesh": (0.0, 0.05, True)}
        weights = [tmp_path / f"networks/{name}/weights.safetensors" for name in ("dragon", "mesh")]
        weights[1].parent.mkdir(parents=True, exist_ok=True)
        weights[1].write_bytes(bytes(8 + 2048))
        trainings = [
            samples.write_record(file.with_name("training.json"), record)
            for file, record in zip(weights, (samples.TRAINING, BUILT))
        ]
        return samples.written_table(
            make_table,
            tmp_path,
            times=times,
            metrics=metrics,
            weights=weights,
            trainings=trainings,
            depth_biases=[
                samples.write_record(
                    tmp_path / f"constants/dragon/{name}.json",
                    samples.constants_of(*found),
                )
                for name, found in biases.items()
            ],
            meshes=[samples.write_mesh(tmp_path, scene, **mesh) for scene in ("dragon", "fence")],
            against={"dragon": "dragon_biased"},
            durations={"dragon": benchmarks, "mesh": benchmarks[:2]},
            rows=ROWS,
        )

    return written


def test_rows_keep_their_order_and_have_the_facts_of_their_kind(written):
    table, md = written()
    assert list(zip(table["scene"], table["method"])) == [(r["scene"], r["label"]) for r in ROWS]
    assert table["lpips"].tolist()[1:] == pytest.approx([0.4, 0.3, 0.05, 0.2, 0.5, 0.5, 0.3, 0.5])
    assert table["seed"].tolist()[1:] == [11] * 6 + [12] * 2
    network = table.iloc[4]
    facts = ["encoding", "stored_bytes", "parameters", "training_seconds", "samples", "depth_bias"]
    assert network[facts].tolist() == ["frequency", 2_227_200, 100, 1.5, 640, 0.01]
    speeds = ["rays_per_second", "frame_ms", "frame_ms_q1", "frame_ms_q3", "own_ms", "device"]
    assert network[speeds].tolist() == [2e6, 7, 6, 8, 2, "cpu"]
    assert (table["depth_bias"][5], table["rays_per_second"][5]) == (0, 1e6)
    # Maps, ray tracing (the reference) and no shadow have what applies to them.
    stored = [np.nan, 2**16, 2**20, 2048, 2_227_200, 2_227_200, np.nan, 2**20, np.nan]
    np.testing.assert_allclose(table["stored_bytes"], stored, rtol=1e-5)
    assert table["resident_bytes"][3] == 5 * 2**20
    assert table.loc[[0, 1, 6], ["encoding", "parameters", "depth_bias"]].isna().all(axis=None)
    assert np.isnan(table["psnr"][0]) and table["frame_ms"][0] == 2

    cells = samples.cells_of(md, 4)
    assert cells["LPIPS ↓"].startswith("0.2000 [0.1")
    assert (cells["stored KiB ↓"], cells["resident KiB ↓"]) == ("2,175", "4,096")
    assert (cells["own ms ↓"], cells["frame ms ↓"], cells["bias"]) == ("2", "7", "0.01")
    # 1.34e+03 would be no number to the page.
    assert samples.cells_of(md, 5)["own ms ↓"] == "1,340"
    assert "Mesh of fence: fence (generated, not the thesis's mesh)" in md.read_text()
    assert [samples.cells_of(md, i)["scene"] for i in (0, 1, 7)] == ["dragon", "", "fence"]


def test_rivals_have_what_networks_have(written):
    table, md = written()
    mesh = table.iloc[3]
    assert mesh["encoding"] == "mesh" and np.isnan(mesh["training_seconds"])
    # A mesh's file, its rays and its training or building; a benchmark that is gone hides the sum.
    assert mesh["build_seconds"] == 1 + 10 + 2 and np.isnan(table["build_seconds"][4])
    assert (mesh["push"], mesh["bias_at_end"]) == (0.05, True)
    assert (
        samples.cells_of(md, 3)["bias"] == "0 †" and "†: at an end of the range" in md.read_text()
    )
    assert mesh["psnr_difference"] > 0 > mesh["lpips_difference"]
    # It needs an inside that its mesh does not have.
    assert mesh["unfit"] and not table["unfit"][4] and np.isnan(table["unfit"][1])
    assert samples.cells_of(md, 3)["method"] == "Mesh (**unfit**)"
    assert table["learned"].isna().tolist() == [True] * 4 + [False] * 2 + [True] * 3
    assert table["learned"][4:6].tolist() == [True, False]
    assert samples.cells_of(md, 5)["method"] == "Network, no bias (**not learned**)"
    assert samples.cells_of(md, 3)["equal map"] == "> 512² / > 512²"


def test_the_thesis_stands_beside_its_own_mesh_and_null_rows_are_last(written):
    table, md = written(thesis_mesh=True)
    name = "Thesis's network, as printed"
    assert table["method"].tolist()[6:8] == [name, "No shadow"]
    assert table["method"].tolist()[9:] == [name, "No shadow"]
    assert table.loc[6, ["scene", "lpips", "psnr", "map_lpips", "map_psnr"]].tolist() == [
        *("dragon", 0.0379, 27.39, "386", "191")
    ]
    cells = samples.cells_of(md, 6)
    assert (cells["pooled PSNR ↑"], cells["LPIPS ↓"]) == ("27.39 (pooled or mean)", "0.0379")
    assert cells["stored KiB ↓"] == "2,175"


def test_times_of_several_devices_do_not_compare(written):
    table, md = written(devices=("cpu", "cuda"))
    assert "**Not comparable**: some methods ran on cpu, others on cuda" in md.read_text()
    assert samples.cells_of(md, 7)["device"] == "cuda"
