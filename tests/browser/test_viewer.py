"""The viewer in a real browser: its answers are the pipeline's, and it does what it is told."""

import numpy as np
import pytest
import torch
import trimesh
from shapes import sheet
from viewer_page import FIELD, make_viewer

from neural_shadows.evaluation.ray_network import network_method
from neural_shadows.evaluation.registry import classic_method
from neural_shadows.rendering.gbuffer import render_gbuffer
from neural_shadows.rendering.viewpoints import draw_viewpoints

SIZE = 300, 200
PIXELS = SIZE[0] * SIZE[1]
# Of all pixels, those that may differ: at outlines, where rounding decides. A CPU's field has the
# values of a cell's corners in eight bits of its own, of the cell's largest: 0.0018 differ.
MOST = {"reference": 0.001, "field": 0.002, "map_256": 0.001, "map_1024": 0.001, "thesis": 0.005}


@pytest.fixture(scope="module")
def viewer(tmp_path_factory):
    return make_viewer(tmp_path_factory.mktemp("viewer"))


@pytest.fixture
def open_viewer(browser, viewer):
    def open_viewer(state="", width=480, height=440, browser=browser):
        page = browser.new_page(viewport={"width": width, "height": height})
        page.set_default_timeout(20_000)
        page.messages, page.requested = [], []
        page.on("pageerror", lambda error: page.messages.append(str(error)))
        page.on("request", lambda request: page.requested.append(request.url))
        page.goto(f"{viewer.html.as_uri()}#{state}")
        page.locator("#viewer.ready, #viewer.failed").wait_for()
        return page

    return open_viewer


def settled(page):
    """Waits until the viewer has come to rest after what was done before, and gives its state."""
    page.locator("#viewer[data-moving='false']").wait_for()
    return dict(part.split("=") for part in page.url.partition("#")[2].split("&"))


def by_cpu(viewer, key, frame):
    if key in viewer.networks:
        answer = network_method(viewer.networks[key], torch.float32)
        return answer(frame)(viewer.biases[key])
    name = {"reference": "ray_traced"}.get(key) or key.replace("map", "shadow_map")
    return classic_method(name, viewer.scene, whole_map=True)(frame)(0.0)


@pytest.fixture(scope="module")
def frames(viewer):
    views = draw_viewpoints(viewer.scene, ["shadow", "surface"], [0], SIZE[0] / SIZE[1], 3)
    return [render_gbuffer(viewer.scene, view, *SIZE) for view in views]


def asked(page, key, frame):
    """Visibility of all pixels by the browser; −1 where there is no surface."""
    view = {key: getattr(frame.view, key).tolist() for key in ("eye", "target")}
    told = [key, view | {"fov": frame.view.fov}, frame.view.light.tolist(), *SIZE]
    answers = np.array(page.evaluate("(told) => viewer.answers(...told)", told), float)
    return np.where(answers < 0, -1, answers / 255)


def test_answers_are_the_pipelines(open_viewer, viewer, frames):
    page = open_viewer("right=no_shadow")
    for frame in frames:
        # The thesis's network takes software seconds a frame: one will do.
        for key in [key for key in MOST if key != "thesis" or frame is frames[0]]:
            expected = np.full(PIXELS, -1.0)
            expected[frame.pixel] = by_cpu(viewer, key, frame)
            of_surface = expected[frame.pixel[frame.lit_side]]
            assert 0.03 < of_surface.mean() < 0.97, f"{key}: nothing to tell apart"
            found = asked(page, key, frame)
            assert np.std(found) > 0.1, "a blank picture"
            assert np.mean(np.abs(found - expected) > 0.5) <= MOST[key], key


def test_filtered_map_is_the_pipelines(open_viewer, viewer, frames):
    page = open_viewer("right=no_shadow")
    expected = by_cpu(viewer, "map_pcf_256", frames[0])
    found = asked(page, "pcf_256", frames[0])[frames[0].pixel]
    between = (expected > 0) & (expected < 1)
    assert between.mean() > 0.005
    # By colours of 8 bits, and heights that differ in their last bits.
    assert np.mean(np.abs(found - expected) > 0.02) < 0.002


def test_answers_of_an_open_sheet(browser, tmp_path):
    """On a sheet any change of sign ends a ray; of untrained logits there are many."""
    settings = {"field": FIELD | {"resolution": 32, "surface": "sheet"}}
    shape = sheet(0.0, 0.6)
    shape.apply_transform(trimesh.transformations.rotation_matrix(0.6, [1, 0, 0]))
    viewer = make_viewer(tmp_path, settings, shape)
    (view,) = draw_viewpoints(viewer.scene, ["shadow"], [0], SIZE[0] / SIZE[1], 3)
    frame = render_gbuffer(viewer.scene, view, *SIZE)
    page = browser.new_page()
    page.goto(f"{viewer.html.as_uri()}#right=no_shadow")
    page.locator("#viewer.ready").wait_for()
    expected, found = by_cpu(viewer, "field", frame), asked(page, "field", frame)[frame.pixel]
    assert 0.03 < expected.mean() < 0.97
    assert np.mean(np.abs(found - expected) > 0.5) <= 0.001


def test_scene_without_a_network_shows_maps(browser, tmp_path):
    page = browser.new_page()
    page.goto(make_viewer(tmp_path, settings={}).html.as_uri())
    page.locator("#viewer[data-moving='false']").wait_for()
    methods = page.evaluate("viewer.methods")
    assert {name.partition("_")[0] for name in methods} == {"map", "pcf", "no", "reference"}
    assert page.locator("select.left").input_value() == "map_1024"
    assert "light leak" in page.locator(".facts.left").inner_text()


def test_page_is_one_file_that_asks_for_nothing(open_viewer, viewer):
    page = open_viewer("right=no_shadow&left=map_64")
    settled(page)
    assert page.messages == []
    assert [url.partition("#")[0] for url in page.requested] == [viewer.html.as_uri()]
    assert page.evaluate("viewer.methods").count("map_4096") == 1


def test_light_follows_the_mouse_and_stays_in_its_domain(open_viewer):
    page = open_viewer("right=no_shadow&left=map_64")
    before, dome = settled(page), page.locator(".dome")
    box = dome.bounding_box()
    page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    page.mouse.down()
    page.mouse.move(box["x"] + 1, box["y"] + box["height"] / 2, steps=4)  # to the left rim
    page.mouse.up()
    after = settled(page)
    assert after["light"] != before["light"] and after["eye"] == before["eye"]
    assert dome.get_attribute("aria-valuenow") == "20"
    dome.focus()
    page.keyboard.press("ArrowRight")
    assert settled(page)["light"] != after["light"]


def test_address_holds_the_state(open_viewer):
    state = "left=map_128&right=pcf_64&divider=30.0&errors=1&fov=40"
    vectors = {"eye": [2, 1, 1], "target": [0.1, 0, 0], "light": [0, 0.8, 0.6]}
    state += "".join(f"&{key}={','.join(f'{x:.4f}' for x in v)}" for key, v in vectors.items())
    page = open_viewer(state)
    found = settled(page)
    given = dict(part.split("=") for part in state.split("&"))
    assert {key: value.replace("%2C", ",") for key, value in found.items()} == given
    assert page.locator(".errors").get_attribute("aria-pressed") == "true"
    assert "false shadow" in page.locator(".facts.left").inner_text()


def test_a_link_pasted_into_the_open_viewer_is_followed(open_viewer):
    page = open_viewer("right=no_shadow&left=map_64&errors=1")
    settled(page)
    page.evaluate("() => { location.hash = 'left=map_128&divider=20'; }")
    found = settled(page)
    assert (found["left"], found["right"], found["divider"]) == ("map_128", "no_shadow", "20.0")
    assert "errors" not in found


def test_nonsense_in_the_address_is_left_out(open_viewer):
    page = open_viewer("left=nobody&right=map_64&divider=-3&eye=1,2&light=0,0,0&fov=nan")
    found = settled(page)
    assert found["left"] == "field" and found["divider"] == "50.0" and page.messages == []


def test_mouse_and_keyboard_turn_the_view(open_viewer):
    page = open_viewer("right=no_shadow&left=map_64")
    views = [settled(page)["eye"]]
    chosen = "select => select.selectedIndex"
    assert page.locator("select.view").evaluate(chosen) == 0
    box = page.locator("canvas").bounding_box()
    page.mouse.move(box["x"] + 100, box["y"] + 100)
    page.mouse.down()
    page.mouse.move(box["x"] + 160, box["y"] + 130, steps=3)
    page.mouse.up()
    views.append(settled(page)["eye"])
    page.locator("canvas").focus()
    for key in ("ArrowLeft", "+", "Shift+ArrowUp"):
        page.keyboard.press(key)
        views.append(settled(page)["eye"])
    assert len(set(views)) == len(views) and page.messages == []
    assert page.locator("select.view").evaluate(chosen) == -1
    page.locator("select.view").select_option("0")
    assert settled(page)["eye"] == views[0]


def test_divider_parts_two_methods(open_viewer):
    page = open_viewer("left=no_shadow&right=map_64&divider=0.0")
    settled(page)
    shot = page.locator("canvas").screenshot()
    page.locator(".over").focus()
    page.keyboard.press("End")
    assert settled(page)["divider"] == "100.0"
    assert page.locator("canvas").screenshot() != shot


def test_day_plays_and_still_is_saved(open_viewer):
    page = open_viewer("right=no_shadow&left=map_64")
    settled(page)
    height = page.locator(".dome").get_attribute("aria-valuetext")
    page.locator(".play").click()
    page.wait_for_timeout(600)
    page.locator(".dome").click()  # stops it
    assert page.locator(".play").get_attribute("aria-pressed") == "false"
    assert page.locator(".dome").get_attribute("aria-valuetext") != height
    with page.expect_download() as saved:
        page.locator(".still").click()
    assert saved.value.suggested_filename == "bumps_map_64_no_shadow.png"


@pytest.mark.parametrize("width", [375, 1280])
def test_page_never_scrolls_sideways(open_viewer, width):
    page = open_viewer("right=no_shadow&left=map_64", width=width)
    assert page.evaluate("document.documentElement.scrollWidth") <= width


def test_without_webgl_there_is_a_poster_and_the_reason(open_viewer, launch):
    page = open_viewer(browser=launch("--disable-gpu", "--disable-3d-apis"))
    assert "no WebGL2" in page.locator(".reason").inner_text()
    assert page.locator(".poster").is_visible() and not page.locator("canvas").is_visible()
    assert page.messages == []
