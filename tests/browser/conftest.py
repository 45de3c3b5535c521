"""Debian's `chromium`, driven by Playwright, with WebGL2 in software."""

import shutil

import pytest

CHROMIUM = shutil.which("chromium") or shutil.which("google-chrome")
# Without its sandbox, which containers do not allow; the pages are our own. Chromium no longer
# falls back to software by itself, and then has no WebGL at all.
ARGUMENTS = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]


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
