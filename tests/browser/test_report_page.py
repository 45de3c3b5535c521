"""The report's page in a real browser."""

import base64
import io

import numpy as np
import pytest
from PIL import Image
from report_page import HOSTILE, LABELS, POINTS, make_page
from soft_pictures import write_soft_pictures

from neural_shadows.reports.data.frame_errors import coloured
from neural_shadows.reports.data.soft_pictures import read_pictures

LIGHT, DARK = "rgb(255, 255, 255)", "rgb(20, 23, 26)"


def paper(page):
    return page.evaluate("getComputedStyle(document.body).backgroundColor")


@pytest.fixture(scope="module")
def address(tmp_path_factory):
    return make_page(tmp_path_factory.mktemp("page")).as_uri()


@pytest.fixture
def open_page(browser, address):
    def open_page(width=1280, height=900, scheme="light", state="", address=address):
        size = {"width": width, "height": height}
        page = browser.new_page(viewport=size, color_scheme=scheme)
        page.set_default_timeout(10_000)
        page.messages, page.requested = [], []
        page.on("console", lambda message: page.messages.append(message.text))
        page.on("pageerror", lambda error: page.messages.append(str(error)))
        page.on("request", lambda request: page.requested.append(request.url))
        page.goto(address + state)
        return page

    return open_page


def divider_at(page):
    return float(page.locator(".divider").get_attribute("aria-valuenow"))


def sources(page):
    """Of the layers under and over the divider the images that are seen."""
    return page.locator(".layer").evaluate_all(
        "layers => layers.map(layer => [...layer.children].map(one => one.hidden || one.src))"
    )


def grey(image):
    return np.repeat(image[..., None], 3, axis=-1)


def drag(page, start, end):
    """Drag over the picture between shares of its width, let go, and move away."""
    stage = page.locator(".stage")
    stage.scroll_into_view_if_needed()
    box = stage.bounding_box()
    middle = box["y"] + box["height"] / 2
    page.mouse.move(box["x"] + start * box["width"], middle)
    page.mouse.down()
    page.mouse.move(box["x"] + end * box["width"], middle, steps=5)
    page.mouse.up()
    page.mouse.move(box["x"] + 0.9 * box["width"], middle)


def test_every_image_loads_and_nothing_else(open_page, address):
    page = open_page()
    page.wait_for_load_state()
    page.evaluate(
        "Promise.allSettled([...document.querySelectorAll('img[src]')].map(image => image.decode()))"
    )
    widths = page.evaluate(
        "[...document.querySelectorAll('img[src]')].map(image => image.naturalWidth)"
    )
    assert len(widths) == 9 and min(widths) > 0
    assert page.messages == []
    assert [url for url in page.requested if not url.startswith("data:")] == [address]


def test_the_viewer_starts_when_asked_for_and_the_page_s_policy_lets_it(open_page, address):
    page = open_page()
    assert page.locator("iframe").count() == 0
    page.get_by_role("link", name="Drag the light").click()
    said = page.frame_locator("iframe").locator("#said")
    said.wait_for()
    assert said.inner_text() == "runs9" and page.locator(".poster").count() == 0
    viewer = address.replace("index.html", "viewer.html")
    assert page.messages == [] and {*page.requested} == {address, viewer}
    assert page.url.endswith("#viewer?left=map_64")


def test_an_address_with_the_viewers_state_opens_it(open_page):
    page = open_page(state="#viewer?left=map_128&divider=30")
    page.frame_locator("iframe").get_by_text("left=map_128&divider=30").wait_for()
    assert page.messages == []


def test_claims_of_one_verdict_are_shown_and_all_again(open_page):
    page = open_page()
    cards = page.locator(".card:visible")
    assert cards.count() == 2
    page.get_by_role("button", name="✓ supported 1").click()
    assert cards.get_attribute("id") == "claim-less"
    page.get_by_role("button", name="All 2").click()
    assert cards.count() == 2


def test_points_of_a_chart_say_their_values_to_pointer_and_keyboard(open_page):
    page = open_page()
    chart, tip = page.locator(".chart"), page.locator("#tip")
    assert tip.is_hidden()
    page.locator(".says circle").first.hover()
    assert tip.inner_text() == HOSTILE
    page.mouse.move(0, 0)
    assert tip.is_hidden()
    chart.focus()
    page.keyboard.press("ArrowRight")
    assert tip.inner_text() == HOSTILE
    chart.blur()
    assert tip.is_hidden()


def test_the_left_key_begins_at_the_last_point(open_page):
    page = open_page()
    page.locator(".chart").focus()
    for text in (*POINTS[::-1], HOSTILE, POINTS[-1]):
        page.keyboard.press("ArrowLeft")
        assert page.locator("#tip").inner_text() == text


def test_a_touched_point_says_its_value_until_another_place_is_touched(browser, address):
    page = browser.new_context(has_touch=True).new_page()
    page.goto(address)
    page.locator(".says circle").nth(1).tap()
    assert page.locator("#tip").inner_text() == POINTS[0]
    page.locator("#found h1").tap()
    assert page.locator("#tip").is_hidden()


def test_contents_follow_the_reading(open_page):
    page = open_page()
    current = page.locator("nav .current")
    assert current.inner_text() == "What was found"
    page.locator("nav").get_by_text("Hard shadows: the thesis").click()
    page.locator("nav .current[href='#thesis']").wait_for()
    assert page.locator("nav").get_by_text("Networks and shadow maps").first.is_visible()
    # On a narrow screen they are folded until asked for.
    narrow = open_page(width=768)
    assert narrow.locator("nav li").first.is_hidden()
    narrow.locator("nav summary").click()
    narrow.locator("nav").get_by_text("How to repeat it").click()
    assert narrow.locator("nav li").first.is_hidden()


def test_without_script_nothing_that_is_read_is_missing(browser, address):
    page = browser.new_context(java_script_enabled=False, color_scheme="dark").new_page()
    page.goto(address)
    assert paper(page) == DARK
    assert page.locator(".card:visible").count() == 2 and page.locator(".filter").is_hidden()
    assert page.locator("#theme").is_hidden()
    assert page.locator(".poster img").is_visible()
    assert page.get_by_role("link", name="Drag the light").get_attribute("href") == "viewer.html"


def test_divider_follows_the_mouse_and_the_keyboard(open_page):
    page = open_page()
    drag(page, 0.5, 0.2)
    assert divider_at(page) == pytest.approx(20, abs=1)
    page.locator(".divider").focus()
    page.keyboard.press("End")
    assert divider_at(page) == 100
    clip = page.locator(".over").evaluate("layer => layer.style.clipPath")
    assert clip == "inset(0px 0% 0px 0px)"
    page.keyboard.press("ArrowLeft")
    assert divider_at(page) == 98


def test_any_two_methods_of_any_view_can_be_compared(open_page):
    page = open_page()
    options = page.locator(".left option").all_inner_texts()
    assert [option[2:] for option in options] == ["Reference", *LABELS.values()]  # of symbols
    seen = {str(sources(page))}
    for selector, value in ((".left", "shadow_map_128"), (".right", "dragon"), (".view", "1")):
        page.locator(selector).select_option(value)
        seen.add(str(sources(page)))
    assert len(seen) == 4
    assert page.locator(".name-left").inner_text().startswith("■ 128² map: LPIPS 0.1100")


def test_what_is_shown_of_a_method_and_that_the_reference_has_no_errors(open_page):
    page = open_page()
    scale, seen = page.locator(".scale"), {}
    for shown in ("errors", "frame", "map"):
        page.locator(".shown").select_option(shown)
        (reference, *others), seen[shown] = sources(page)
        assert others == [True, True]  # hidden
        assert (seen[shown][0] == reference) == (shown != "map")
        assert scale.nth(0).is_visible() == (shown == "errors")
        assert scale.nth(1).is_visible() == (shown == "map")
    assert True not in seen["errors"] and seen["frame"] == [*seen["errors"][:2], True]
    assert seen["map"][1:] == [True, True]


@pytest.fixture
def soft_page(open_page, tmp_path):
    """A page of soft frames, and those of its first scene."""
    soft = write_soft_pictures(tmp_path)
    paths = {path.stem: path for path in soft["soft_answers"]}
    pictures = read_pictures(soft["soft_parts"][0], paths, [0, 1])
    return open_page(address=make_page(tmp_path, references=[], **soft).as_uri()), pictures


def painted(page, side):
    """Levels (height, width, 3) of the canvas under or over the divider, and its name."""
    layer = page.locator(f".{side}[aria-busy='false']")
    address, name = layer.locator("canvas").evaluate(
        "canvas => [canvas.toDataURL(), canvas.getAttribute('aria-label')]"
    )
    content = base64.b64decode(address.removeprefix("data:image/png;base64,"))
    return np.asarray(Image.open(io.BytesIO(content)).convert("RGB"), int), name


def test_soft_frames_are_shaded_masks_or_errors(soft_page):
    page, pictures = soft_page
    # It opens under the largest light, by the method of most error and by the network.
    assert page.locator(".lights [aria-pressed='true']").inner_text() == "0.25 m"
    exact, answer = pictures.exact[1], pictures.answers["hard"][1]
    levels, name = painted(page, "over")
    assert name == "■ Shadow map, shaded pictures, room, light of 0.25 m radius"
    # With a little loss of visibility and shading.
    np.testing.assert_allclose(levels, 255 * grey(pictures.shown(answer)), atol=5)
    page.locator(".shown").select_option("visibility")
    np.testing.assert_allclose(painted(page, "over")[0], 255 * grey(answer), atol=4)
    assert page.locator(".scale").is_hidden()
    page.locator(".shown").select_option("errors")
    error, (levels, _) = answer - exact, painted(page, "over")
    shade, rounding = 0.5 / 8, 1 / 63
    np.testing.assert_allclose(levels, 255 * coloured(error), atol=255 * (shade + 2 * rounding))
    assert (levels[error == 0] == 255).all()
    assert error.max() > 0.1 and (levels[error > 0.1].argmax(-1) == 2).all()  # a leak is blue
    dark, (levels, _) = pictures.error("my_network", 1), painted(page, "under")
    assert dark.min() < -0.1 and (levels[dark < -0.1].argmax(-1) == 0).all()  # orange
    assert page.locator(".scale").is_visible() and page.messages == []
    page.locator(".left").select_option("reference")
    assert (painted(page, "over")[0] == 255).all()


def test_a_light_and_a_scene_are_chosen(soft_page):
    page, pictures = soft_page
    page.locator(".shown").select_option("visibility")
    soft, _ = painted(page, "under")
    page.locator(".lights button").first.click()
    hard, name = painted(page, "under")
    assert name.endswith("visibility alone, room, point light")
    np.testing.assert_allclose(hard, 255 * grey(pictures.answers["my_network"][0]), atol=4)
    assert np.abs(hard - soft).max() > 50
    assert page.locator(".name-left").inner_text() == "■ Shadow map: MSE 161.3 × 10⁻⁴"
    page.locator(".view").select_option("1")
    assert painted(page, "under")[1].endswith("tree, point light") and page.messages == []


def test_the_last_of_many_quick_choices_is_painted(soft_page):
    page, pictures = soft_page
    page.evaluate(
        """() => {
          const select = document.querySelector(".left");
          for (const value of ["rt_4", "hard", "reference", "my_network"]) {
            select.value = value;
            select.dispatchEvent(new Event("change"));
          }
        }"""
    )
    levels, name = painted(page, "over")
    assert name.startswith("✦ Network, shaded")
    expected = grey(pictures.shown(pictures.answers["my_network"][1]))
    np.testing.assert_allclose(levels, 255 * expected, atol=5)


def test_a_double_click_zooms_and_leaves_the_divider(open_page):
    page = open_page()
    page.locator(".stage").dblclick(position={"x": 90, "y": 60})
    assert page.locator(".zoom output").inner_text() == "2×"
    assert divider_at(page) == 50


def test_zoom_shows_single_pixels(open_page):
    page = open_page()
    image = page.locator(".under img:first-child")
    before = image.bounding_box()["width"]
    page.locator(".in").click()
    page.locator(".in").click()
    assert image.bounding_box()["width"] == pytest.approx(4 * before, rel=0.01)
    assert image.evaluate("image => getComputedStyle(image).imageRendering") == "pixelated"
    page.locator(".reset").click()
    assert image.bounding_box()["width"] == pytest.approx(before, rel=0.01)


def test_zoomed_picture_is_moved_by_the_mouse_and_the_keyboard(open_page):
    page = open_page()
    image, step = (
        page.locator(".under img:first-child"),
        0.1 * page.locator(".stage").bounding_box()["width"],
    )
    page.locator(".divider").focus()
    page.keyboard.press("+")
    start = image.bounding_box()
    drag(page, 0.3, 0.4)
    dragged = image.bounding_box()
    assert dragged["x"] - start["x"] == pytest.approx(step, abs=3)
    page.locator(".divider").focus()
    page.keyboard.press("Shift+ArrowRight")
    after = image.bounding_box()
    assert dragged["x"] - after["x"] == pytest.approx(step, abs=1)
    assert divider_at(page) == 50


@pytest.mark.parametrize("width", [375, 768, 1280])
def test_page_never_scrolls_sideways(open_page, width):
    page = open_page(width=width)
    assert page.evaluate("document.documentElement.scrollWidth") == width


def test_light_dark_and_print(open_page):
    light, dark = open_page(), open_page(scheme="dark")
    assert paper(light) == LIGHT
    assert paper(dark) == DARK
    light.locator("#theme").click()
    assert paper(light) == DARK
    # Print leaves out what paper cannot do.
    dark.emulate_media(media="print")
    assert dark.locator(".controls").is_hidden()
    assert dark.locator(".stage").is_visible()
    assert paper(dark) == LIGHT
    link = "getComputedStyle(document.querySelector('main a')).color"
    assert dark.evaluate(link) == open_page().evaluate(link)
    assert dark.pdf(format="A4").startswith(b"%PDF")
