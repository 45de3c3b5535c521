"""axe-core, a checker of accessibility, finds no fault in the page: contrast, names, headings."""

import pytest
from report_page import make_page


@pytest.fixture(scope="module")
def sample(tmp_path_factory):
    return make_page(tmp_path_factory.mktemp("page"))


def faults(page):
    """Each fault with the elements that have it."""
    axe = pytest.importorskip(
        "axe_playwright_python.sync_playwright", reason="no axe: pip install -r envs/browser.txt"
    ).Axe()
    violations = axe.run(page).response["violations"]
    return {fault["id"]: [node["target"] for node in fault["nodes"]][:5] for fault in violations}


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("width", [375, 1280])
def test_a_page_has_no_fault_folded_or_unfolded(browser, sample, width, scheme):
    page = browser.new_page(viewport={"width": width, "height": 900}, color_scheme=scheme)
    page.goto(sample.as_uri())
    assert faults(page) == {}
    page.evaluate("for (const one of document.querySelectorAll('details')) one.open = true")
    assert faults(page) == {}
