import json
import re
from collections import Counter

import pytest
from report_page import HOSTILE, LABELS, SHARED, VIEWER, make_page
from soft_pictures import write_soft_pictures


@pytest.fixture(scope="module")
def text(tmp_path_factory):
    return make_page(tmp_path_factory.mktemp("page")).read_text()


def attributes(text, name):
    return re.findall(rf'<[^<>]*\s{name}="([^"]*)"', text)


def test_page_asks_for_nothing_outside_itself(text):
    assert not re.search(r"@import|url\((?!#)|<(link|iframe|object)\b", text)
    addresses = attributes(text, "src") + attributes(text, "href")
    assert all(address.startswith(("data:", "#")) for address in addresses) and addresses


def test_text_from_the_config_is_shown_not_run(text):
    assert HOSTILE not in text and text.count("<script") == 3
    viewer, data = re.findall(r'<script type="application/json">(.+?)</script>', text)
    assert json.loads(viewer) == VIEWER
    data = json.loads(data)
    assert data["title"].startswith(f"dragon: {HOSTILE}")
    assert [method["name"] for method in data["methods"]] == [
        "★ Reference",
        *(f"{symbol} {label}" for symbol, label in zip("■■●", LABELS.values())),
    ]


def test_every_link_leads_to_one_place(text):
    ids = Counter(attributes(text, "id"))
    assert ids.most_common(1)[0][1] == 1
    links = {address[1:] for address in attributes(text, "href") if address[0] == "#"}
    assert {"claims", "tables", "extensions", "table-tables", "table-beyond"} <= links <= set(ids)


def test_notes_are_shown_once_and_what_is_past_the_thesis_apart(text):
    assert text.count(SHARED) == 1
    assert re.search(r"<figcaption>Figure 4.1\s+<span", text)  # its title is in the picture
    assert '<article id="table-beyond">' in text[text.index('<section id="extensions">') :]


@pytest.mark.parametrize("there", ["tables", "figures", "claims_json", "references"])
def test_page_shows_what_is_there(tmp_path, there):
    parts = {"tables", "figures", "claims_json", "references", "meshes", "trainings", "lpips_json"}
    missing = {name: None if "_" in name else [] for name in parts - {there}}
    text = make_page(tmp_path, **missing, viewers=[], kinds={}).read_text()
    section = {"claims_json": "claims", "references": "compare"}.get(there, there)
    sections = re.findall(r'<section id="(\w+)"', text)
    assert [name for name in sections if name != "extensions"] == [section, "run"]


def test_a_contact_sheet_is_folded_and_no_other_figure(text):
    figures = re.findall(r'<figure id="figure-(\w+)">(.+?)</figure>', text, re.DOTALL)
    assert len(figures) > 1
    assert [name for name, inside in figures if "<details>" in inside] == ["figure_4_1"]


def test_the_first_screen_has_the_viewer_and_the_front(text):
    first = text[text.index('<header id="found">') : text.index("</header>")]
    assert first.index('id="viewer"') < first.index('id="figure-figure_front"')
    assert text.count('id="figure-figure_front"') == 1


def test_nothing_of_the_machine_s_paths_enters_the_page(tmp_path):
    assert str(tmp_path) not in make_page(tmp_path).read_text()


def test_what_is_asked_for_and_not_there_is_named_once_where_it_would_stand(tmp_path):
    names = {"found": "viewer.html", "compare": "frames of 1", "tables": "table_4_1.md"}
    names |= {"figures": "figure_4_4.svg", "extensions": "figure_front.svg"}
    none = dict.fromkeys(("tables", "figures", "references", "viewers"), [])
    missing = {section: [name] for section, name in names.items()}
    text = make_page(tmp_path, **none, missing=missing).read_text()
    for section, name in names.items():
        assert text.count(f"Not made yet: {name}.") == 1
        assert text.index(f'id="{section}"') < text.index(name) < text.index('<section id="run"')
        assert f'href="#{section}"' in text
    assert "Drag the divider" not in text and "A dot is our number" not in text


def test_the_first_viewer_is_in_the_page_and_the_others_are_named(text):
    assert "files of the same folder: viewer_fence.html" in text
    assert "Not made yet" not in text


def test_soft_shadows_are_compared_and_led_to_from_their_tables(tmp_path):
    soft = write_soft_pictures(tmp_path)
    names = ("table_4_3", "beyond", "figure_4_1", "figure_front")
    chapters = dict.fromkeys(names, "thesis") | {"tables": "soft"}
    text = make_page(tmp_path, **soft, chapters=chapters).read_text()
    assert text.count('<article class="compare"') == 2
    assert attributes(text, "id").count("compare-soft-rivals") == 1
    section = text[text.index('<section id="soft">') :]
    assert 'href="#compare-soft-rivals"' in section
    # Hard shadows have a FLIP map, soft ones errors by their size.
    assert text.count("FLIP map</option>") == text.count("errors alone</option>") == 1
