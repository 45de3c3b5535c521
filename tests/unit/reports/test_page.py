import json
import re
from collections import Counter
from html.parser import HTMLParser

import pytest
from report_page import HOSTILE, LABELS, SHARED, make_page


class Page(HTMLParser):
    """All elements of a page as (tag, attributes)."""

    def __init__(self, text):
        super().__init__()
        self.elements = []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.elements.append((tag, dict(attrs)))

    def values(self, key):
        return [attributes[key] for _, attributes in self.elements if key in attributes]


@pytest.fixture(scope="module")
def text(tmp_path_factory):
    return make_page(tmp_path_factory.mktemp("page")).read_text()


def test_page_asks_for_nothing_outside_itself(text):
    page = Page(text)
    assert not {tag for tag, _ in page.elements} & {"link", "iframe", "object"}
    for address in filter(None, page.values("src") + page.values("href")):
        assert address.startswith(("data:", "#")), address
    assert not re.search(r"@import|url\(", text)


def test_text_from_the_config_is_shown_not_run(text):
    assert HOSTILE not in text
    assert len([tag for tag, _ in Page(text).elements if tag == "script"]) == 2
    data = json.loads(re.search(r'<script type="application/json">(.+?)</script>', text)[1])
    assert data["title"].startswith(f"dragon: {HOSTILE}")
    assert [method["name"] for method in data["methods"]] == ["Reference", *LABELS]


def test_every_link_leads_to_one_place(text):
    page = Page(text)
    ids = Counter(page.values("id"))
    assert ids.most_common(1)[0][1] == 1
    links = {address.removeprefix("#") for address in page.values("href")}
    assert links <= set(ids)
    assert {"claims", "tables", "beyond", "table-tables", "table-beyond"} <= links


def test_notes_are_shown_once_and_what_is_past_the_thesis_apart(text):
    assert text.count(SHARED) == text.count("Mean over 24 views") == 1
    assert "<figcaption>Figure 4.1</figcaption>" in text  # its title is in the picture
    section = text[text.index('<section id="beyond">') :]
    assert "<h2>Past the thesis</h2>" in section and '<article id="table-beyond">' in section


@pytest.mark.parametrize("there", ["tables", "figures", "claims_md", "pictures"])
def test_page_shows_what_is_there(tmp_path, there):
    parts = ("tables", "figures", "claims_md", "pictures", "meshes", "trainings", "lpips_json")
    kept = [there, "meshes"] if there == "pictures" else [there]
    nothing = {name: None if "_" in name else [] for name in parts if name not in kept}
    page = Page(make_page(tmp_path, **nothing).read_text())
    section = {"claims_md": "claims", "pictures": "compare"}.get(there, there)
    sections = [attributes["id"] for tag, attributes in page.elements if tag == "section"]
    assert [name for name in sections if name != "beyond"] == ["run", section]
