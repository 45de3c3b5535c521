import json
import re
from collections import Counter

import pytest
from report_page import HOSTILE, LABELS, SHARED, make_page, table
from soft_pictures import write_soft_pictures

from neural_shadows.reports.data import run_command
from neural_shadows.reports.data.table import write_table
from neural_shadows.reports.page.blocks import pictures_once


@pytest.fixture(scope="module")
def text(tmp_path_factory):
    return make_page(tmp_path_factory.mktemp("page")).read_text()


def attributes(text, name):
    return re.findall(rf'<[^<>]*\s{name}="([^"]*)"', text)


def test_page_asks_for_nothing_outside_itself(text):
    assert not re.search(r"@import|url\((?!#)|<(link|iframe|object)\b", text)
    viewers = {"viewer.html", "viewer_soft.html"}  # beside it, by links
    addresses = {*attributes(text, "src"), *attributes(text, "href")} - viewers
    assert all(address.startswith(("data:", "#")) for address in addresses) and addresses


def test_text_from_the_config_is_shown_not_run(text):
    assert HOSTILE not in text and text.count("<script") == 3
    (data,) = re.findall(r'<script type="application/json">(.+?)</script>', text)
    data = json.loads(data)
    assert data["title"].startswith(f"dragon: {HOSTILE}")
    assert [method["name"] for method in data["methods"]] == [
        "★ Reference",
        *(f"{symbol} {label}" for symbol, label in zip("■■✶", LABELS.values())),
    ]


def test_every_link_leads_to_one_place(text):
    ids = Counter(attributes(text, "id"))
    assert ids.most_common(1)[0][1] == 1
    links = {address[1:] for address in attributes(text, "href") if address[0] == "#"}
    assert {"claims", "thesis", "extensions", "table-tables", "table-beyond"} <= links <= set(ids)
    assert {"claim-less", "figure-figure_4_1", "facts"} <= links


def test_notes_are_shown_once_and_what_is_past_the_thesis_apart(text):
    assert text.count(SHARED) == 1
    assert re.search(r"<figcaption>Figure 4.1\s+<span", text)  # its title is in the picture
    assert '<article id="table-beyond">' in text[text.index('<section id="extensions">') :]


@pytest.mark.parametrize("there", ["tables", "figures", "claims_json", "references"])
def test_page_shows_what_is_there(tmp_path, there):
    parts = {"tables", "figures", "claims_json", "references", "meshes", "trainings", "lpips_json"}
    missing = {name: None if "_" in name else [] for name in parts - {there}}
    text = make_page(tmp_path, **missing, viewers=[], kinds={}).read_text()
    section = {"claims_json": "claims", "references": "compare"}.get(there, "thesis")
    sections = re.findall(r'<section id="(\w+)"', text)
    assert [name for name in sections if name != "extensions"] == [section, "run"]


def test_a_contact_sheet_is_folded_and_no_other_figure(text):
    figures = re.findall(r'<figure id="figure-(\w+)">(.+?)</figure>', text, re.DOTALL)
    assert len(figures) > 1
    assert [name for name, inside in figures if "<details>" in inside] == ["figure_4_1"]


def test_the_first_screen_has_the_findings_that_were_judged_and_the_viewer(text):
    first = text[text.index('<header id="found">') : text.index("</header>")]
    assert first.index("Is less more?") < first.index('id="viewer"')
    assert re.search(
        r'class="finding supported">\s*<a href="#figure-figure_4_1"><img alt="&lt;script', first
    )
    assert "Is nothing?" not in text


def test_many_tables_are_folded_and_claims_by_text(tmp_path, text):
    assert text.count("<details open>") == 3 and '<details class="source" open>' in text
    many = [tmp_path / f"t{number}.json" for number in range(4)]
    for path in many:
        write_table(table(), path.with_suffix(".csv"), path.with_suffix(".md"), path)
    chapters = {path.stem: "networks" for path in many} | {"figure_4_1": "thesis"}
    chapters |= {"figure_front": "extensions"}
    folded = make_page(tmp_path, tables=many, data={}, chapters=chapters).read_text()
    assert "<details open>" not in folded
    sections = re.findall(r'<section id="(\w+)"', folded)
    assert sections == ["compare", "thesis", "extensions", "networks", "claims", "run"]


def test_nothing_of_the_machine_s_paths_enters_the_page(tmp_path):
    assert str(tmp_path) not in make_page(tmp_path).read_text()


def test_what_is_not_made_yet_is_folded_at_the_end(tmp_path):
    names = ["viewer", "table_4_1", "frames of 1 of 2 methods on dragon"]
    none = dict.fromkeys(("tables", "figures", "references", "viewers"), [])
    text = make_page(tmp_path, **none, missing=names).read_text()
    end = text[text.index('<section id="run">') :]
    assert "<summary>Not made yet: 3 of this configuration</summary>" in end
    assert text.count(", ".join(names)) == 1 and ", ".join(names) in end
    assert "Drag the divider" not in text and "A dot is our number" not in text


def test_a_run_of_ones_own_is_no_reproduction(tmp_path, text):
    none = {"claims_json": None, "tables": [], "trainings": []}
    own = make_page(tmp_path, **none).read_text()
    assert "Two papers say yes" in text and "a diamond the text" in text
    assert "Two papers say yes" not in own and "<h1>Neural shadows: wyrm, " in own


def test_viewers_are_linked_by_their_titles(text):
    links = re.findall(r'<a href="(viewer\w*.html)">(.*?)</a>', text)
    assert links == [
        ("viewer.html", "Viewer"),
        ("viewer_soft.html", "Soft shadows: room &amp; dragon"),
    ]
    assert "from 0 to 5°" in text and "An area light can be dragged" in text
    assert "Not made yet" not in text


def test_a_viewer_of_an_area_light_alone_has_no_sun(tmp_path):
    soft = tmp_path / "viewer.html"
    text = make_page(tmp_path, viewers=[soft], soft_viewers=["viewer"]).read_text()
    assert "from 0 to 5°" not in text and "An area light can be dragged" in text


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
    assert text.count("FLIP map</option>") == text.count("visibility alone</option>") == 1


def test_a_picture_of_two_comparisons_is_on_the_page_once():
    first, second = "data:image/webp;base64,AA==", "data:image/webp;base64,BB=="
    data = [
        {"views": [{"map": first}, {"map": second}]},
        {"name": "data", "views": [{"map": first}]},
    ]
    numbered, pictures = pictures_once(data)
    assert pictures == [first, second]
    maps = [view["map"]["picture"] for one in numbered for view in one["views"]]
    assert maps == [0, 1, 0] and numbered[1]["name"] == "data"


def test_the_command_of_the_run(tmp_path, monkeypatch):
    monkeypatch.setenv(run_command.VARIABLE, "snakemake --config 'dragon=<b>.ply'")
    text = make_page(tmp_path).read_text(encoding="utf-8")
    assert "<code>snakemake --config &#39;dragon=&lt;b&gt;.ply&#39;</code>" in text
    monkeypatch.delenv(run_command.VARIABLE)
    assert "The run's last command" not in make_page(tmp_path).read_text(encoding="utf-8")
