"""Tables S2 to S5 of Neural Shadow Mapping, of a profile whose times are known."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from report_samples import MACHINE, PUBLISHED, write_record, written_figure, written_table
from shipped import shipped

from neural_shadows.networks.screen_space.widths import by_level, convolutions
from neural_shadows.reports.claims.kinds.ratio import of_another_size
from neural_shadows.reports.data.published import read_published
from neural_shadows.reports.figures.screen_level_time import draw
from neural_shadows.reports.tables import screen_levels, screen_networks, screen_parts

PRINTED = PUBLISHED.with_name("published_nsm.csv")
WIDTHS = [16, 32, 64, 128, 256]
ON_THE_WAY = ("encoder", "downsample", "upsample", "decoder")


def profile(folder: Path, width=2048, height=1024) -> Path:
    """Part number i of level k takes (i + 1) / 4^k ms in bfloat16, ten times that in float32."""
    layers = convolutions("full", WIDTHS, 4)
    counts = {name: by_level(layers, name) for name in ("weights", "macs", "storage")}
    places = [(k, part) for k in range(4) for part in ON_THE_WAY] + [(4, "encoder")]
    parts = [
        {"level": k, "part": part, "ms": (ON_THE_WAY.index(part) + 1) / 4**k} for k, part in places
    ]
    slow = [part | {"ms": 10 * part["ms"]} for part in parts]
    same = {"device": "cpu", "threads": 2, "product_macs": 1e12}
    runs = [
        {**same, "precision": "float32", "whole_ms": 140.0, "parts": slow},
        {**same, "precision": "bfloat16", "whole_ms": 14.0, "parts": parts},
    ]
    levels = [{"level": k} | {name: each[k] for name, each in counts.items()} for k in range(5)]
    about = {"width": width, "height": height, "repeats": 10, "warm_up": 3, "product_size": 2048}
    about |= {"formats": ["float32", "bfloat16"]}
    record = about | {"levels": levels, "runs": runs, "machine": MACHINE}
    return write_record(folder / "profile.json", record)


def made(module, folder, published, **given):
    given |= {"published_nsm_csv": PRINTED, "published": published}
    return written_table(module.table, folder, **given)


def test_the_file_of_printed_numbers_is_whole():
    published = read_published(PRINTED)
    assert len(published) == 127 and published.index.is_unique and np.isfinite(published).all()
    parts = published["nsm.s3"].unstack()
    # The paper's own sums; of level 1 the parts are 3.68 and the total is printed as 3.67.
    sums = parts.drop(columns="total").sum(axis=1)
    assert (sums - parts["total"]).abs().max() < 0.04


def test_levels_stand_beside_the_printed_ones(tmp_path):
    table, md = made(screen_levels, tmp_path, "nsm.s2", profile_json=profile(tmp_path))
    assert table["runtime"].tolist() == pytest.approx([10, 2.5, 0.625, 0.15625, 1 / 256], rel=1e-4)
    assert table["ms_float32_2"].tolist() == pytest.approx(10 * table["runtime"], rel=1e-4)
    assert table["runtime_minus_printed"][0] == pytest.approx(-1.0)
    for name, most in {"compute": 0.005, "parameters": 0.05, "storage_io": 0.1}.items():
        assert table[f"{name}_minus_printed"].abs().max() < most
    assert "device" in table and of_another_size(table, "runtime", table["device"][0]) == ""
    assert of_another_size(table, "runtime", "tpu") == "times on tpu are needed"
    # 7.147 GMAC in 10 ms, of 1000 GMAC a second
    assert table["product_share"][0] == pytest.approx(0.7147, rel=1e-3)
    assert "table S2 of Datta et al. 2022" in md.read_text()
    assert "bfloat16, 2 threads 14 ms, 243 % of the" in md.read_text()


def test_frames_of_another_size_have_no_differences_but_of_weights(tmp_path):
    small = profile(tmp_path, 64, 32)
    table, md = made(screen_levels, tmp_path, "nsm.s2", profile_json=small)
    assert table[["runtime_minus_printed", "compute_minus_printed"]].isna().all(axis=None)
    assert table["parameters_minus_printed"].notna().all()
    table, _ = made(screen_parts, tmp_path, "nsm.s3", profile_json=small)
    assert table["ms_minus_printed"].isna().all()


def test_parts_stand_beside_the_printed_ones_and_are_drawn(tmp_path):
    table, _ = made(screen_parts, tmp_path, "nsm.s3", profile_json=profile(tmp_path))
    row = table.set_index(["level", "part"]).loc[(1, "upsample")]
    assert row["ms"] == pytest.approx(0.75) and row["printed_ms"] == 0.12
    assert row["ms_minus_printed"] == pytest.approx(0.63)
    skip = table.set_index(["level", "part"]).loc[(0, "skip")]
    assert np.isnan(skip["ms"]) and skip["printed_ms"] == 0.37
    assert table[["share", "printed_share"]].sum().tolist() == pytest.approx([1, 1], abs=1e-4)
    said = written_figure(draw, tmp_path, table_csv=tmp_path / "table.csv")
    assert (tmp_path / "figure.png").stat().st_size > 10_000
    assert "ours, bfloat16, 2 threads: 13.29 ms" in said and "RTX 2080 Ti: 17.24 ms" in said
    assert "level 1, upsample: 0.75 ms" in said


def test_a_profile_without_printed_numbers_is_drawn_alone(tmp_path):
    table, _ = made(screen_parts, tmp_path, None, profile_json=profile(tmp_path))
    assert table["printed_ms"].isna().all()
    text = written_figure(draw, tmp_path, table_csv=tmp_path / "table.csv")
    assert "Datta" not in text


@pytest.mark.parametrize("name", ["s4", "s5"])
def test_counts_of_depths_are_the_printed_ones(tmp_path, name):
    values = shipped()
    rows = values["tables"][f"nsm_table_{name}"]["networks"]
    rows = [{"network": row} if isinstance(row, str) else row for row in rows]
    networks = [
        {
            "name": row["network"],
            "published": row.get("published", row["network"]),
            "settings": values["networks"][row["network"]],
        }
        for row in rows
    ]
    table, _ = made(screen_networks, tmp_path, f"nsm.{name}", networks=networks)
    assert table["mac_per_pixel_minus_printed"].tolist() == [0, 0, 0]
    # as many digits as are printed: thousands to one or two decimals, 1,626 and 9,501 to none
    assert (table["parameters_minus_printed"].abs() / table["parameters"]).max() < 3e-4
    assert isinstance(table, pd.DataFrame) and table["levels"].tolist() == [3, 5, 7]
