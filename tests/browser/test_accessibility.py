"""Checkers find no fault in a page: axe-core of contrast, names and headings, html5lib of HTML."""

import pytest
from checkout import ROOT
from report_page import make_page


@pytest.fixture(scope="module", params=["sample", "reference"])
def html(request, tmp_path_factory):
    if request.param == "sample":
        return make_page(tmp_path_factory.mktemp("page"))
    return ROOT / "reports/reference/index.html"


def faults(page):
    """Each fault with the elements that have it."""
    axe = pytest.importorskip(
        "axe_playwright_python.sync_playwright", reason="no axe: pip install -r envs/browser.txt"
    ).Axe()
    violations = axe.run(page).response["violations"]
    return {fault["id"]: [node["target"] for node in fault["nodes"]][:5] for fault in violations}


@pytest.mark.parametrize(("width", "scheme"), [(375, "light"), (1280, "dark")])
def test_a_page_has_no_fault_folded_or_unfolded(browser, html, width, scheme):
    page = browser.new_page(viewport={"width": width, "height": 900}, color_scheme=scheme)
    page.goto(html.as_uri())
    assert faults(page) == {}
    page.evaluate("for (const one of document.querySelectorAll('details')) one.open = true")
    assert faults(page) == {}


def test_a_page_is_valid_html(html):
    html5lib = pytest.importorskip(
        "html5lib", reason="no html5lib: pip install -r envs/browser.txt"
    )
    parser = html5lib.HTMLParser()
    parser.parse(html.read_text(encoding="utf-8"))
    assert parser.errors == []
