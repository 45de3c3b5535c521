import math

from report_page import SHARED, TABLE

from neural_shadows.reports.method_look import LOOKS
from neural_shadows.reports.page_tables import table_block

OF_SCENES = """# Two scenes

| scene | method           | pooled PSNR ↑     | stored KiB ↓ | thesis KiB | thesis equal map | empty |
|:------|:-----------------|------------------:|-------------:|-----------:|-----------------:|------:|
| one   | Field (**unfit**) | 41.0 [40.0, 42.0] |        1,024 |      2,048 |                  |       |
|       | 512² shadow map  | 35.0 [34.0, 36.0] |          512 |            |                  |       |
|       | No shadow        | 45.0              |              |            |                  |       |
| two   | Field            | 0.01 [0.01, 0.02] |              |            |      386² / 191² |       |
|       | 512² shadow map  | 1.00 [0.80, 1.20] |              |            |                  |       |

- How to read it.
"""


def written(folder, text):
    path = folder / "table.md"
    path.write_text(text)
    path.with_suffix(".csv").write_text("a\n1\n")
    return table_block(path, {"Field": LOOKS["occupancy_field"]})


def test_the_thesis_s_numbers_stand_and_are_drawn_in_the_cells_of_ours(tmp_path):
    block = written(tmp_path, TABLE)
    (part,) = block.parts
    assert part.heads == ["method", "LPIPS ↓", "verdict"]
    ours = part.rows[0][1]
    assert (ours.html, ours.interval, ours.theirs) == ("0.01", " [0.005, 0.02]", "0.0329")
    # All of a column on one scale, from 0.005 to 0.08; the thesis's LPIPS is not on it.
    assert ours.places[:3] == [5.5, 0.0, 16.4] and math.isnan(ours.places[3])
    assert part.rows[1][1].places[2] == 82 and part.logarithmic == []
    assert part.rows[0][2].html == "<strong>supported</strong>" and not part.rows[0][2].places
    assert part.rows[1][0].html == "A &lt;b&gt;network&lt;/b&gt;"
    assert block.notes == ("Mean over 24 views; <em>thesis</em>: printed.", SHARED)
    assert block.files == {"table.csv": "data:text/csv;base64,YQoxCg=="}


def test_scenes_stand_apart_with_the_best_of_each(tmp_path):
    one, two = written(tmp_path, OF_SCENES).parts
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
    rows = ["| light | method | MSE ↓ |", "|---|---|---|"]
    rows += ["| point light | A | 1 |", "| point light | B | 2 |"]
    rows += ["| light of 1 m radius | A | 6 |", "| light of 1 m radius | B | 5 |"]
    one, two = written(tmp_path, "# Soft\n\n" + "\n".join(rows) + "\n").parts
    assert (one.scene, two.scene) == ("point light", "light of 1 m radius")
    assert [row[1].best for row in one.rows + two.rows] == [True, False, False, True]


def test_what_the_thesis_prints_is_a_diamond_and_its_lpips_none(tmp_path):
    text = """# Networks

| method                       |            LPIPS ↓ |             SSIM ↑ | thesis SSIM | KiB |
|:-----------------------------|-------------------:|-------------------:|------------:|----:|
| Field                        | 0.01 [0.005, 0.02] | 0.50 [0.40, 0.60]  |        0.80 |   1 |
| Thesis's network, as printed |               0.90 |               0.70 |             |   2 |

- How to read it.
"""
    (part,) = written(tmp_path, text).parts
    (_, lpips, ssim, size), (_, printed_lpips, printed_ssim, _) = part.rows
    assert lpips.places[2] == 82 and all(map(math.isnan, printed_lpips.places))
    assert ssim.places == [20.5, 0.0, 41.0, 82.0]  # 0.4 to 0.8
    assert printed_ssim.places[3] == 61.5 and all(map(math.isnan, printed_ssim.places[:3]))
    assert size.places is None
