"""The report's page in a real browser: Debian's `chromium`, driven by Playwright."""

import shutil

import pytest
from report_page import make_page

CHROMIUM = next(
    filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None
)
pytestmark = pytest.mark.skipif(
    CHROMIUM is None, reason="no Chromium on this machine: apt-get install chromium"
)
playwright_api = pytest.importorskip(
    "playwright.sync_api", reason="no Playwright: pip install -r envs/browser.txt"
)


@pytest.fixture(scope="module")
def browser():
    with playwright_api.sync_playwright() as playwright:
        # Without its sandbox, which containers do not allow; the page is our own.
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        yield browser
        browser.close()


@pytest.fixture(scope="module")
def address(tmp_path_factory):
    return make_page(tmp_path_factory.mktemp("page")).as_uri()


@pytest.fixture
def open_page(browser, address):
    contexts = []

    def open_page(width=1280, height=900, scheme="light"):
        context = browser.new_context(
            viewport={"width": width, "height": height}, color_scheme=scheme
        )
        contexts.append(context)
        page = context.new_page()
        page.set_default_timeout(10_000)
        page.messages, page.requested = [], []
        page.on("console", lambda message: page.messages.append(message.text))
        page.on("pageerror", lambda error: page.messages.append(str(error)))
        page.on("request", lambda request: page.requested.append(request.url))
        page.goto(address)
        return page

    yield open_page
    for context in contexts:
        context.close()


def divider_at(page):
    return float(page.locator(".divider").get_attribute("aria-valuenow"))


def clip_of(page):
    return page.locator(".over").evaluate("layer => layer.style.clipPath")


def sources(page):
    return page.locator(".layer img").evaluate_all("images => images.map(image => image.src)")


def test_nothing_is_logged_and_nothing_else_is_loaded(open_page, address):
    page = open_page()
    page.wait_for_load_state()
    assert page.messages == []
    others = [url for url in page.requested if not url.startswith("data:")]
    assert others == [address]


def test_every_image_loads(open_page):
    page = open_page()
    page.evaluate("Promise.allSettled([...document.images].map(image => image.decode()))")
    widths = page.evaluate("[...document.images].map(image => image.naturalWidth)")
    assert len(widths) == 3
    assert min(widths) > 0


def test_divider_follows_the_mouse(open_page):
    page = open_page()
    stage = page.locator(".stage")
    stage.scroll_into_view_if_needed()
    box = stage.bounding_box()
    middle = box["y"] + box["height"] / 2
    before = clip_of(page)
    page.mouse.move(box["x"] + box["width"] / 2, middle)
    page.mouse.down()
    page.mouse.move(box["x"] + 0.2 * box["width"], middle, steps=5)
    page.mouse.up()
    assert divider_at(page) == pytest.approx(20, abs=1)
    assert clip_of(page) != before
    page.mouse.move(box["x"] + 0.9 * box["width"], middle)  # let go: it stays
    assert divider_at(page) == pytest.approx(20, abs=1)


def test_divider_follows_the_keyboard(open_page):
    page = open_page()
    page.locator(".divider").focus()
    page.keyboard.press("ArrowLeft")
    assert divider_at(page) == 48
    page.keyboard.press("End")
    assert divider_at(page) == 100
    assert clip_of(page) == "inset(0px 0% 0px 0px)"
    page.keyboard.press("Home")
    assert divider_at(page) == 0


def test_any_two_methods_of_any_view_can_be_compared(open_page):
    page = open_page()
    options = page.locator(".left option").all_inner_texts()
    assert options == ["Reference", "128² shadow map", "512² shadow map", "Thesis's network"]
    seen = {tuple(sources(page))}
    for selector, value in ((".left", "shadow_map_128"), (".right", "dragon"), (".view", "1")):
        page.locator(selector).select_option(value)
        seen.add(tuple(sources(page)))
    assert len(seen) == 4
    assert page.locator(".name-left").inner_text().startswith("128² shadow map: LPIPS 0.1100")


def test_map_takes_the_place_of_the_frame(open_page):
    page = open_page()
    before = sources(page)
    assert page.locator(".scale").is_hidden()
    page.locator(".map").click()
    after = sources(page)
    assert before[0] != after[0]
    assert before[1] != after[1]
    assert page.locator(".scale").is_visible()
    page.locator(".map").click()
    assert sources(page) == before


def test_zoom_shows_single_pixels(open_page):
    page = open_page()
    image = page.locator(".under img")
    before = image.bounding_box()["width"]
    page.locator(".in").click()
    page.locator(".in").click()
    assert image.bounding_box()["width"] == pytest.approx(4 * before, rel=0.01)
    rendering = image.evaluate("image => getComputedStyle(image).imageRendering")
    assert rendering == "pixelated"
    page.locator(".out").click()
    assert page.locator("output").inner_text() == "2×"
    page.locator(".reset").click()
    assert image.bounding_box()["width"] == pytest.approx(before, rel=0.01)


def test_zoomed_picture_can_be_moved(open_page):
    page = open_page()
    stage = page.locator(".stage")
    stage.scroll_into_view_if_needed()
    page.locator(".in").click()
    before = page.locator(".under img").bounding_box()
    box = stage.bounding_box()
    page.mouse.move(box["x"] + 0.3 * box["width"], box["y"] + 0.5 * box["height"])
    page.mouse.down()
    page.mouse.move(box["x"] + 0.4 * box["width"], box["y"] + 0.5 * box["height"], steps=4)
    page.mouse.up()
    after = page.locator(".under img").bounding_box()
    assert after["x"] - before["x"] == pytest.approx(0.1 * box["width"], abs=3)
    assert divider_at(page) == 50


def test_zoomed_picture_can_be_moved_by_the_keyboard(open_page):
    page = open_page()
    page.locator(".divider").focus()
    page.keyboard.press("+")
    before = page.locator(".under img").bounding_box()
    page.keyboard.press("Shift+ArrowRight")
    page.keyboard.press("Shift+ArrowDown")
    after = page.locator(".under img").bounding_box()
    step = 0.1 * page.locator(".stage").bounding_box()["width"]
    assert before["x"] - after["x"] == pytest.approx(step, abs=1)
    assert before["y"] - after["y"] == pytest.approx(step, abs=1)
    assert divider_at(page) == 50


def test_contents_lead_to_every_table_and_figure(open_page):
    page = open_page()
    links = page.locator("details a, nav a").evaluate_all(
        "links => links.map(link => link.getAttribute('href'))"
    )
    assert {"#table-table_4_3", "#figure-figure_4_1", "#claims", "#compare"} <= set(links)
    for link in links:
        assert page.locator(link).count() == 1


@pytest.mark.parametrize("width", [375, 768, 1280])
def test_page_never_scrolls_sideways(open_page, width):
    page = open_page(width=width)
    assert page.evaluate("document.documentElement.scrollWidth") == width


def test_light_and_dark(open_page):
    def paper(page):
        return page.evaluate("getComputedStyle(document.body).backgroundColor")

    light, dark = open_page(), open_page(scheme="dark")
    assert paper(light) == "rgb(255, 255, 255)"
    assert paper(dark) == "rgb(20, 23, 26)"
    light.locator("#theme").click()
    assert paper(light) == "rgb(20, 23, 26)"


def test_print_leaves_out_what_paper_cannot_do(open_page):
    page = open_page(scheme="dark")
    page.emulate_media(media="print")
    assert page.locator(".controls").is_hidden()
    assert page.locator(".stage").is_visible()
    assert page.evaluate("getComputedStyle(document.body).backgroundColor") == "rgb(255, 255, 255)"
    assert page.pdf(format="A4").startswith(b"%PDF")
