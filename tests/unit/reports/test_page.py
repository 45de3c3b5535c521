import base64
import io
import json
import re
from html.parser import HTMLParser

import numpy as np
import pytest
from PIL import Image
from report_page import HOSTILE, frames, write_page

from neural_shadows.errors import InputError
from neural_shadows.reports.page import (
    LARGEST_SVG,
    comparison,
    figure_block,
    map_picture,
    method_name,
    table_block,
)


class Page(HTMLParser):
    """All elements of a page as (tag, attributes), and the text of each cell."""

    def __init__(self, text):
        super().__init__()
        self.elements = []
        self.cells = []
        self._cell = None
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.elements.append((tag, dict(attrs)))
        if tag in ("td", "th"):
            self._cell = [dict(attrs).get("class"), ""]
            self.cells.append(self._cell)

    def handle_endtag(self, tag):
        if tag in ("td", "th"):
            self._cell = None

    def handle_data(self, data):
        if self._cell is not None:
            self._cell[1] += data


@pytest.fixture(scope="module")
def text(tmp_path_factory):
    return write_page(tmp_path_factory.mktemp("page")).read_text()


def decoded(uri):
    kind, content = re.fullmatch(r"data:image/([a-z+]+);base64,(.+)", uri).groups()
    return kind, base64.b64decode(content)


def test_page_asks_for_nothing_outside_itself(text):
    page = Page(text)
    for tag, attributes in page.elements:
        assert tag not in ("link", "iframe", "object")
        for key in ("src", "href"):
            if attributes.get(key):
                assert attributes[key].startswith(("data:", "#")), (tag, attributes)
    assert "@import" not in text
    assert not re.search(r"url\(", text)


def test_text_from_the_config_is_shown_not_run(text):
    assert HOSTILE not in text
    scripts = [attributes for tag, attributes in Page(text).elements if tag == "script"]
    assert len(scripts) == 2  # the comparison's data and the page's own
    data = re.search(r'<script type="application/json">(.+?)</script>', text)[1]
    assert json.loads(data)["title"] == f"dragon {HOSTILE}"


def test_cells_tell_the_thesis_from_ours_and_verdicts_apart(text):
    cells = Page(text).cells
    assert ["thesis", "0.0379"] in cells
    assert ["thesis", "thesis PSNR"] in cells
    assert [None, "0.07 [0.065, 0.08]"] in cells
    assert ["supported", "supported"] in cells
    assert ["contradicted", "contradicted"] in cells
    assert [None, "supported by nobody"] in cells
    assert [None, "Our <b>method</b>"] in cells


def test_keyboard_reaches_what_scrolls_in_its_own_box(text):
    boxes = [attributes for _, attributes in Page(text).elements if "scroll" in attributes.values()]
    assert [box["tabindex"] for box in boxes] == ["0", "0"]
    assert [box["aria-label"] for box in boxes] == [
        "What the thesis claims",
        "Our method and shadow maps (table 4.3 of the thesis)",
    ]


def test_frames_are_stored_without_loss():
    data = comparison("dragon", "the dragon", frames())
    original = frames()[1].images["dragon"]
    kind, content = decoded(data["views"][1]["pictures"]["dragon"]["frame"])
    assert kind == "webp"
    stored = np.asarray(Image.open(io.BytesIO(content)).convert("L"))
    np.testing.assert_array_equal(stored, original)
    assert [method["key"] for method in data["methods"]][0] == "reference"
    assert (data["left"], data["right"]) == ("dragon", "reference")
    assert data["views"][0]["pictures"]["dragon"]["scores"] == "LPIPS 0.1000, PSNR 22.00 dB"


def test_map_is_black_where_nothing_differs():
    picture = np.asarray(map_picture(np.array([[0.0, 0.5, 1.0]])))
    assert picture[0, 0].tolist() == [0, 0, 4]
    assert picture[0, 2].tolist() == [252, 253, 191]  # magma's ends
    data = comparison("dragon", "", frames())
    _, content = decoded(data["views"][0]["pictures"]["reference"]["map"])
    assert np.asarray(Image.open(io.BytesIO(content))).max() == 4


def test_large_drawings_are_shown_as_pixels(tmp_path):
    svg, png = tmp_path / "figure_3_1.svg", tmp_path / "figure_3_1.png"
    Image.new("RGB", (9, 9), "red").save(png)
    for size, kind in ((LARGEST_SVG, "svg+xml"), (LARGEST_SVG + 1, "webp")):
        svg.write_bytes(b"x" * size)
        block = figure_block("How", svg, png)
        assert decoded(re.search('src="([^"]+)"', block.html)[1])[0] == kind
        assert (block.key, block.title) == ("figure_3_1", "Figure 3.1: How")


def test_figure_that_is_missing_is_named(tmp_path):
    with pytest.raises(InputError, match=r"figure_3_1\.svg: cannot be read .*; run the figure"):
        figure_block("How", tmp_path / "figure_3_1.svg", tmp_path / "figure_3_1.png")


def test_methods_have_names():
    assert method_name("shadow_map_512") == "512² shadow map"
    assert method_name("dragon_64") == "network dragon_64"


@pytest.mark.parametrize("text", ["", "# Only a heading\n", "| a |\n|---|\n| 1 |\n"])
def test_what_is_no_table_is_named(tmp_path, text):
    path = tmp_path / "table_4_1.md"
    path.write_text(text)
    with pytest.raises(InputError, match=r"table_4_1\.md: holds no table"):
        table_block(path)


def test_what_is_past_the_thesis_has_a_heading_of_its_own(text):
    section = text[text.index('<section id="beyond">') :]
    assert "<h2>Past the thesis</h2>" in section and "<p>Other networks</p>" in section
    assert '<article id="fronts">' in section
    assert text.count('href="#fronts"') == 1 and 'href="#beyond"' in text


def test_only_figures_of_the_thesis_have_numbers(tmp_path):
    for name in ("figure_4_3", "figure_beyond_dragon"):
        (tmp_path / f"{name}.svg").write_text("<svg/>")
    titles = [
        figure_block("Loss", tmp_path / f"{name}.svg", tmp_path / "none.png").title
        for name in ("figure_4_3", "figure_beyond_dragon")
    ]
    assert titles == ["Figure 4.3: Loss", "Loss"]
