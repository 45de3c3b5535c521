import math

import numpy as np
import pandas as pd
from report_page import SHARED, table

from neural_shadows.reports.data.method_look import LOOKS
from neural_shadows.reports.data.table import Column, Table, intervals, numbers, write_table
from neural_shadows.reports.page.table_blocks import table_block

NAN = math.nan


def block_of(folder, columns, notes=()):
    return written(folder, Table(pd.DataFrame({"a": [1]}), columns, notes, "A table"))


def written(folder, table):
    csv, md, json = (folder / f"table.{ending}" for ending in ("csv", "md", "json"))
    write_table(table, csv, md, json)
    return table_block(json, {"Field": LOOKS["occupancy_field"]})


def with_ends(values, low, high, decimals=1):
    frame = pd.DataFrame({"value": values, "low": low, "high": high})
    return intervals(frame, [*frame], decimals)


def test_the_thesis_s_numbers_stand_and_are_drawn_in_the_cells_of_ours(tmp_path):
    block = written(tmp_path, table())
    (part,) = block.parts
    assert part.heads == ["method", "LPIPS ↓", "verdict"]
    ours = part.rows[0][1]
    assert (ours.html, ours.interval, ours.theirs) == ("0.010", " [0.005, 0.020]", "0.0329")
    # All of a column on one scale, from 0.005 to 0.08; the thesis's LPIPS is not on it.
    assert ours.places[:3] == [5.5, 0.0, 16.4] and math.isnan(ours.places[3])
    assert part.rows[1][1].places[2] == 82 and part.logarithmic == []
    assert part.rows[0][2].html == "<strong>supported</strong>" and not part.rows[0][2].places
    assert part.rows[1][0].html == "A &lt;b&gt;network&lt;/b&gt;"
    assert block.notes == ("Mean over 24 views; <em>thesis</em>: printed.", SHARED)
    assert block.files == {"table.csv": "data:text/csv;charset=utf-8,a%0A1%0A"}


def test_scenes_stand_apart_with_the_best_of_each(tmp_path):
    field, shadow_map = "Field", "512² shadow map"
    labels = [field, shadow_map, "No shadow", field, shadow_map]
    texts = ["Field (**unfit**)", *labels[1:]]
    values = [41, 35, 45, 0.01, 1.0], [40, 34, NAN, 0.01, 0.8], [42, 36, NAN, 0.02, 1.2]
    columns = {
        "scene": ["one", "", "", "two", ""],
        "method": Column(texts, labels=labels),
        "pooled PSNR ↑": with_ends(*values, decimals=2),
        "stored KiB ↓": numbers([1024, 512, NAN, NAN, NAN], "{:,.0f}"),
        "thesis KiB": numbers([2048] + [NAN] * 4, "{:,.0f}", printed_of="stored KiB ↓"),
        "thesis equal map": ["", "", "", "386² / 191²", ""],
        "empty": [""] * 5,
    }
    one, two = block_of(tmp_path, columns).parts
    assert (one.scene, two.scene) == ("one", "two")
    assert one.heads == ["method", "pooled PSNR ↑", "stored KiB ↓"]
    # No shadow cannot be the best.
    assert [[cell.best for cell in row[1:]] for row in one.rows] == [
        [True, False],
        [False, True],
        [False, False],
    ]
    assert one.looks == [LOOKS["occupancy_field"], None, None]
    assert one.rows[0][2].numbers[0] == 1024 and one.rows[0][2].theirs == "2,048"
    # A column of the thesis's without one of ours stands alone; values far apart are logarithmic.
    assert two.heads == ["method", "pooled PSNR ↑", "thesis equal map"]
    assert (one.logarithmic, two.logarithmic) == ([], ["pooled PSNR ↑"])
    assert 0 < two.rows[0][1].places[2] / 82 - math.log(2) / math.log(120) < 0.01


def test_lights_stand_apart_with_the_best_of_each(tmp_path):
    lights = ["point light"] * 2 + ["light of 1 m radius"] * 2
    columns = {"light": lights, "method": ["A", "B"] * 2, "MSE ↓": numbers([1, 2, 6, 5], "{:.0f}")}
    one, two = block_of(tmp_path, columns).parts
    assert (one.scene, two.scene) == ("point light", "light of 1 m radius")
    assert [row[1].best for row in one.rows + two.rows] == [True, False, False, True]


def test_what_the_thesis_prints_is_a_diamond_and_its_lpips_none(tmp_path):
    lpips = with_ends([0.01, 0.9], [0.005, NAN], [0.02, NAN], 3)
    columns = {
        "method": ["Field", "Thesis's network, as printed"],
        "LPIPS ↓": Column(lpips.texts, lpips.values, lpips.intervals, lpips.ends, comparable=False),
        "SSIM ↑": with_ends([0.5, 0.7], [0.4, NAN], [0.6, NAN], 2),
        "thesis SSIM": numbers([0.8, NAN], "{:.2f}", printed_of="SSIM ↑"),
        "KiB": numbers(np.array([1, 2]), "{:.0f}"),
    }
    (part,) = block_of(tmp_path, columns).parts
    (_, lpips, ssim, size), (_, printed_lpips, printed_ssim, _) = part.rows
    assert lpips.places[2] == 82 and all(map(math.isnan, printed_lpips.places))
    assert ssim.places == [20.5, 0.0, 41.0, 82.0]  # 0.4 to 0.8
    assert printed_ssim.places[3] == 61.5 and all(map(math.isnan, printed_ssim.places[:3]))
    assert size.places is None


def test_large_numbers_keep_their_digits(tmp_path):
    (part,) = block_of(tmp_path, {"method": ["A"], "ms ↓": numbers([1340.0], "{:,.0f}")}).parts
    assert part.rows[0][1].text == "1,340" and part.rows[0][1].numbers[0] == 1340
