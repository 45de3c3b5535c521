"""A browser, driven by Playwright."""

import pytest
from chromium import ARGUMENTS, CHROMIUM


@pytest.fixture(scope="session")
def launch():
    """Starts a browser with more arguments."""
    if CHROMIUM is None:
        pytest.skip("no Chromium on this machine: apt-get install chromium")
    api = pytest.importorskip(
        "playwright.sync_api", reason="no Playwright: pip install -r envs/browser.txt"
    )
    with api.sync_playwright() as playwright:
        opened = []

        def launch(*arguments):
            start = playwright.chromium.launch
            opened.append(start(executable_path=CHROMIUM, args=[*ARGUMENTS, *arguments]))
            return opened[-1]

        yield launch
        for browser in opened:
            browser.close()


@pytest.fixture(scope="session")
def browser(launch):
    return launch()
