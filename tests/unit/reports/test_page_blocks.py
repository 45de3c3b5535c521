from PIL import Image
from report_page import SHARED, TABLE

from neural_shadows.reports.page_blocks import LARGEST_SVG, figure_blocks, table_block


def test_cells_tell_the_thesis_from_ours_and_verdicts_apart(tmp_path):
    path = tmp_path / "table_4_3.md"
    path.write_text(TABLE)
    block = table_block(path)
    assert '<th style="text-align:right" class="thesis">thesis LPIPS</th>' in block.html
    assert '<td style="text-align:right" class="thesis">0.0379</td>' in block.html
    assert '<td style="text-align:right">0.07 <small>[0.065, 0.08]</small></td>' in block.html
    assert 'class="supported"><strong>supported</strong></td>' in block.html
    assert "A &lt;b&gt;network&lt;/b&gt;" in block.html
    assert block.notes == ("Mean over 24 views; <em>thesis</em>: printed.", SHARED)


def test_large_drawings_are_shown_as_pixels(tmp_path):
    svg, png = tmp_path / "figure_3_1.svg", tmp_path / "figure_3_1.png"
    Image.new("RGB", (9, 9), "red").save(png)
    for size, kind in ((LARGEST_SVG, "svg+xml"), (LARGEST_SVG + 1, "webp")):
        svg.write_bytes(b"x" * size)
        (block,) = figure_blocks([svg, png], {"figure_3_1": "How"})
        assert f'src="data:image/{kind};base64,' in block.html
        assert (block.anchor, block.title) == ("figure-figure_3_1", "Figure 3.1: How")
    # Only figures of the thesis have numbers.
    (block,) = figure_blocks([png.rename(tmp_path / "figure_cost.png")], {"figure_cost": "Cost"})
    assert (block.title, block.caption) == ("Cost", "")
