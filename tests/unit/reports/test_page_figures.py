import io
import re
from urllib.parse import unquote
from xml.etree import ElementTree

import pandas as pd
from PIL import Image

from neural_shadows.reports.drawing.chart import add_tooltip
from neural_shadows.reports.drawing.style import new_figure, write_figure
from neural_shadows.reports.page.blocks import Block
from neural_shadows.reports.page.figure_blocks import LARGEST_SVG, figure_blocks, inline_svg


def test_large_drawings_and_pictures_are_shown_as_pixels(tmp_path):
    svg, png = tmp_path / "figure_3_1.svg", tmp_path / "figure_3_1.png"
    Image.new("RGB", (9, 9), "red").save(png)
    for content in (b"<image", b"x" * (LARGEST_SVG + 1)):
        svg.write_bytes(content)
        (block,) = figure_blocks([svg, png], {"figure_3_1": "How"}, {})
        assert 'src="data:image/avif;base64,' in block.html
        assert (block.anchor, block.title) == ("figure-figure_3_1", "Figure 3.1: How")
    # Only figures of the thesis have numbers.
    table = Block("table", "cost", "Costs")
    png = png.rename(tmp_path / "figure_cost.png")
    (block,) = figure_blocks([png], {"figure_cost": "Cost"}, {"figure_cost": table})
    assert (block.title, block.caption) == ("Cost", "")
    assert block.files == {"its table": "#table-cost"}  # whose CSV is on the page already


def test_a_drawing_in_the_page_is_whole_and_follows_its_colours(tmp_path):
    figure = new_figure("A <b>title</b>", 4, 3)
    axes = figure.subplots()
    axes.plot([1, 2], [3, 4], "o", color="#0072b2")
    axes.plot([1, 2], [4, 4], color="#777777")
    axes.set_xlabel("a < b")
    chart = figure, pd.DataFrame({"a": [1]})  # whose letters stay letters
    write_figure(chart, tmp_path / "f.png", tmp_path / "f.svg")
    html = inline_svg((tmp_path / "f.svg").read_bytes(), "figure_x", "Title")
    root = ElementTree.fromstring(html.replace("xlink:", ""))
    assert root.get("aria-label") == "Title" and root.get("viewBox") == "0 0 288 216"
    ids = [element.get("id") for element in root.iter() if element.get("id")]
    assert ids and all(name.startswith("figure_x-") for name in ids)
    used = [element.get("href") for element in root.iter("use")]
    clips = [e.get("clip-path") for e in root.iter() if e.get("clip-path")]
    named = {name.removeprefix("#") for name in used} | {clip[5:-1] for clip in clips}
    assert used and clips and named == {*ids}
    assert "<style" not in html and "metadata" not in html and "&#10;" not in html
    assert ">a &lt; b</text>" in html and not re.search(r">\s|\d\.\d{3}|font-family", html)
    assert "fill: var(--paper)" in html and "#ffffff" not in html
    assert "stroke: #0072b2" in html and "stroke: var(--soft)" in html
    drawn = ElementTree.fromstring((tmp_path / "f.svg").read_bytes())
    painted = ("path", "use", "text")  # whose order says what covers what
    orders = [[e.tag.split("}")[-1] for e in tree.iter()] for tree in (drawn, root)]
    before, after = ([tag for tag in order if tag in painted] for order in orders)
    assert before == after and "<g>" not in html


def test_a_chart_s_own_data_can_be_saved(tmp_path):
    svg = tmp_path / "figure_4_1.svg"
    data = pd.DataFrame({"curve": ["a, b"], "loss": [0.5]})
    figure = new_figure("Loss", 3, 2)
    write_figure((figure, data), svg.with_suffix(".png"), svg)
    (block,) = figure_blocks([svg], {}, {})
    saved = unquote(block.files["figure_4_1.csv"].removeprefix("data:text/csv;charset=utf-8,"))
    pd.testing.assert_frame_equal(pd.read_csv(io.StringIO(saved)), data)
    assert "a, b" not in block.html
    assert "tabindex" not in block.html  # it has no point that the arrow keys could choose
    (point,) = figure.subplots().plot([1], [2], "o")
    add_tooltip(point, "a: 2")
    write_figure(figure, svg.with_suffix(".png"), svg)
    assert 'tabindex="0"' in figure_blocks([svg], {}, {})[0].html
