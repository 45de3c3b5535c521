"""The viewer in a real browser: its answers are the pipeline's, and it does what it is told."""

import base64
import io

import numpy as np
import pytest
import torch
import trimesh
from PIL import Image
from shapes import bumpy_sphere, hills, looking, scene_of, sheet, unit
from viewer_page import FIELD, make_viewer

from neural_shadows.evaluation.ray_network import network_method
from neural_shadows.evaluation.registry import classic_method
from neural_shadows.networks.object_space.occupancy_field_network import CELL_SHARE
from neural_shadows.rendering.gbuffer import render_gbuffer
from neural_shadows.rendering.viewpoints import draw_viewpoints
from neural_shadows.representations.distance_bricks.distances_around import distances_around
from neural_shadows.representations.distance_bricks.field_cones import (
    ConeField,
    above_plane,
    dim_by_field,
    split_disc,
)
from neural_shadows.viewer.mesh_arrays import BITS

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
    pages = []

    def open_viewer(state="", width=480, height=440, browser=browser, script=""):
        page = browser.new_page(viewport={"width": width, "height": height})
        page.add_init_script(script)
        pages.append(page)
        page.set_default_timeout(60_000)
        page.messages, page.requested = [], []
        page.on("pageerror", lambda error: page.messages.append(str(error)))
        page.on("console", lambda message: page.messages.append(message.text))
        page.on("request", lambda request: page.requested.append(request.url))
        page.goto(f"{viewer.html.as_uri()}#{state}")
        page.locator("#viewer.ready, #viewer.failed").wait_for()
        return page

    yield open_viewer
    for page in pages:  # one at rest is busy
        page.close()


def settled(page):
    """Waits until the viewer has come to rest after what was done before, and gives its state."""
    page.locator("#viewer[data-moving='false']").wait_for()
    return dict(part.split("=") for part in page.url.partition("#")[2].split("&"))


def refined(page):
    """Waits until the picture is drawn in full, and both methods are compared."""
    page.locator("#viewer[data-refined='true']").wait_for()
    return settled(page)


def faults(page):
    """What the page and its WebGL complain about; that a test reads pixels is slow, and meant."""
    return [text for text in page.messages if "GPU stall due to ReadPixels" not in text]


def drawn(page):
    """The canvas, (height, width, 3) uint8."""
    data = page.evaluate("document.querySelector('canvas').toDataURL()").partition(",")[2]
    return np.asarray(Image.open(io.BytesIO(base64.b64decode(data))).convert("RGB"))


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


def asked(page, key, frame, sun=0.0):
    """Visibility of all pixels by the browser; −1 where there is no surface; sun: in degrees."""
    view = {key: getattr(frame.view, key).tolist() for key in ("eye", "target")}
    given = [
        key,
        view | {"fov": frame.view.fov},
        frame.view.light.tolist(),
        frame.width,
        frame.height,
        sun,
    ]
    return np.array(page.evaluate("(given) => viewer.answers(...given)", given), float)


def test_answers_are_the_pipelines(open_viewer, viewer, frames):
    page = open_viewer("left=no_shadow&right=no_shadow")
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
    page = open_viewer("left=no_shadow&right=no_shadow")
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
    page.goto(f"{viewer.html.as_uri()}#left=no_shadow&right=no_shadow")
    page.locator("#viewer.ready").wait_for()
    expected, found = by_cpu(viewer, "field", frame), asked(page, "field", frame)[frame.pixel]
    assert 0.03 < expected.mean() < 0.97
    assert np.mean(np.abs(found - expected) > 0.5) <= 0.001


def test_scene_without_a_network_shows_maps(browser, tmp_path):
    page = browser.new_page()
    page.goto(make_viewer(tmp_path, settings={}).html.as_uri())
    page.locator("#viewer[data-refined='true']").wait_for()
    methods = page.evaluate("viewer.methods")
    assert {name.partition("_")[0] for name in methods} == {"map", "pcf", "pcss", "no", "reference"}
    assert page.locator("select.left").input_value() == "map_256"
    assert "light leak" in page.locator(".facts.left").inner_text()


def test_page_is_one_file_that_asks_for_nothing(open_viewer, viewer):
    page = open_viewer("right=no_shadow&left=map_64")
    settled(page)
    assert faults(page) == []
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
    state = "left=map_128&right=pcf_64&divider=30.0&errors=1&sun=2.5&fov=40"
    vectors = {"eye": [2, 1, 1], "target": [0.1, 0, 0], "light": [0, 0.8, 0.6]}
    state += "".join(f"&{key}={','.join(f'{x:.4f}' for x in v)}" for key, v in vectors.items())
    page = open_viewer(state)
    found = refined(page)
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
    page = open_viewer("left=nobody&right=map_64&divider=-3&eye=1,2&light=0,0,0&fov=nan&sun=9")
    found = settled(page)
    assert found["left"] == "thesis" and found["divider"] == "50.0" and faults(page) == []
    assert "sun" not in found


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
    assert len(set(views)) == len(views) and faults(page) == []
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


def edge_of_a_plate(half=0.45, height=0.5):
    """A plate over x < 0, and a foot that sets the ground's height, on a step of the page's vertices."""
    foot = 2 * round(0.2 * (2**BITS - 1)) / (2**BITS - 1) - 1
    plate, foot_sheet = sheet(height, half), sheet(foot, 0.01)
    plate.apply_translation([-half, 0, 0])
    foot_sheet.apply_translation([-0.6, 0, 0])
    return trimesh.util.concatenate([plate, foot_sheet])


def share_of_disc(edge):
    """Of a unit disc, the part on its middle's side of a straight edge."""
    m = np.clip(edge, -1, 1)
    return 1 - (np.arccos(m) - m * np.sqrt(1 - m * m)) / np.pi


@pytest.fixture
def plate(browser, tmp_path):
    """A page of the plate under a sun straight above, a frame of it, and tangents of the edge."""
    viewer = make_viewer(tmp_path, settings={}, shape=edge_of_a_plate())
    view = looking(eye=(1.2, -0.2, 0.05), light=unit(0, 1, 0), target=(0, -0.6, 0), fov=30)
    frame = render_gbuffer(viewer.scene, view, *SIZE)
    page = browser.new_page()
    page.goto(f"{viewer.html.as_uri()}#left=no_shadow&right=no_shadow")
    page.locator("#viewer.ready").wait_for()
    x, y, z = frame.p.T
    near = ~frame.is_object[frame.lit_side] & (np.abs(x) < 0.3) & (np.abs(z) < 0.3)
    corners = viewer.scene.objects[0].vertices
    edge, height = corners[corners[:, 1] > 0, 0].max(), corners[:, 1].max()
    yield page, frame, frame.pixel[frame.lit_side][near], (x[near] - edge) / (height - y[near])
    page.close()


@pytest.mark.parametrize("sun", [1.0, 5.0])
@pytest.mark.parametrize("key, most", [("reference", 0.08), ("pcss_2048", 0.12)])
def test_penumbra_of_a_half_plane(plate, key, most, sun):
    page, frame, pixels, tangents = plate
    expected = share_of_disc(tangents / np.tan(np.radians(sun / 2)))
    within = (expected > 0.02) & (expected < 0.98)
    assert within.mean() > 0.02 and (expected == 0).any() and (expected == 1).any()
    found = asked(page, key, frame, sun)[pixels]
    # Of 64 rays, and of 32 texels after blockers of 16.
    assert np.abs(found - expected).max() < most
    assert np.abs(found - expected)[within].mean() < most / 4
    assert np.abs((found - expected)[within].mean()) < most / 8


def test_cones_through_the_field_are_the_pipelines(open_viewer, viewer):
    (view,) = draw_viewpoints(viewer.scene, ["shadow"], [0], SIZE[0] / SIZE[1], 3)
    frame, network = render_gbuffer(viewer.scene, view, *SIZE), viewer.networks["field"]
    ground = ~frame.is_object[frame.lit_side]
    points, size = frame.p[ground], round(len(network.grid) ** (1 / 3))
    bricks, scale = network._brick_values()
    grid = network.grid.view(size, size, size).numpy()
    unit_of_value = np.float32(scale / CELL_SHARE * 2 / network.resolution)
    field = ConeField(grid, bricks, unit_of_value, distances_around(grid, bricks).ravel())
    far, slope = np.float32(1000), np.float32(np.tan(np.radians(1.5)))
    normals = np.tile(np.float32([0, 1, 0]), (len(points), 1))
    to_light = np.tile((far * view.light).astype(np.float32), (len(points), 1))
    expected = above_plane(normals, to_light, slope * far)
    around = np.zeros(3, np.float32), np.float32(1), field
    arguments = split_disc(8), np.float32(network.push)
    dim_by_field(points, normals, to_light, slope * far, *around, *arguments, expected)
    assert ((expected > 0.02) & (expected < 0.98)).mean() > 0.02
    page = open_viewer("left=no_shadow&right=no_shadow")
    found = asked(page, "field", frame, 3.0)[frame.pixel[frame.lit_side][ground]]
    # Distances around are in eighths of a cell here.
    assert np.abs(found - expected).max() < 0.05 and np.abs(found - expected).mean() < 0.002
    exact = asked(page, "reference", frame, 3.0)[frame.pixel[frame.lit_side][ground]]
    assert np.abs(found - exact).mean() < 0.02


def test_network_s_rays_spread_over_the_sun(open_viewer, viewer, frames):
    """Not all of its answers: software takes 64 times as long as for hard shadows."""
    frame = render_gbuffer(viewer.scene, frames[0].view, 48, 32)
    page = open_viewer("left=no_shadow&right=no_shadow")
    hard, soft = (asked(page, "thesis", frame, sun) for sun in (0.0, 5.0))
    assert not ((hard > 0) & (hard < 1)).any() and ((soft > 0) & (soft < 1)).mean() > 0.01
    assert abs(soft.mean() - hard.mean()) < 0.05


def test_facts_hold_what_a_method_does_about_a_sun(open_viewer):
    page = open_viewer("left=map_64&right=pcss_64&sun=3")
    refined(page)
    left, right = (page.locator(f".facts.{side}").inner_text() for side in ("left", "right"))
    assert "hard under any sun" in left and "PCSS" in right
    page.locator("input.sun").fill("0")
    assert "sun" not in refined(page)
    assert "hard" not in page.locator(".facts.left").inner_text()


FROM_ABOVE = "eye=0.1,4,0.1&target=0,0,0&fov=50&light=0,0.8,0.6"


def ground_of(viewer, image):
    """The frame that a picture of `FROM_ABOVE` shows, and the ground's colours (n, 3)."""
    view = looking((0.1, 4, 0.1), np.array([0, 0.8, 0.6]), fov=50)
    frame = render_gbuffer(viewer.scene, view, image.shape[1], image.shape[0])
    return frame, image.reshape(-1, 3)[frame.pixel[~frame.is_object]]


def test_picture_at_rest_is_refined_to_full_size(open_viewer, viewer):
    """Of hard shadows the flat ground has two colours, and between them none that are interpolated."""
    page = open_viewer(f"left=reference&right=map_2048&{FROM_ABOVE}", width=900, height=700)
    refined(page)
    image = drawn(page)
    box = page.locator("canvas").bounding_box()
    assert image.shape[:2] == (round(box["height"]), round(box["width"]))
    assert page.locator(".rate").inner_text() == f"{image.shape[1]} × {image.shape[0]}"
    frame, ground = ground_of(viewer, image)
    colours, counts = np.unique(ground, axis=0, return_counts=True)
    two = np.argsort(counts)[-2:]
    assert counts[two].min() > 0.01 * len(ground) and counts[two].sum() > 0.999 * len(ground)
    # What the CPU calls dark is the darker colour.
    exact = by_cpu(viewer, "reference", frame)[~frame.is_object]
    dark = ground[:, 0] == colours[two, 0].min()
    assert np.mean(dark != (exact == 0)) < 0.002
    assert faults(page) == []


def test_moving_picture_is_enlarged_smoothly(open_viewer, viewer):
    """The thesis's network has time for few pixels; between dark and lit the ground has no steps."""
    page = open_viewer(f"left=thesis&right=thesis&{FROM_ABOVE}", width=900, height=700)
    settled(page)
    page.locator(".play").click()
    page.wait_for_timeout(2000)
    width = page.locator(".rate").inner_text().partition(" ×")[0]
    image = drawn(page)
    assert int(width) <= image.shape[1] / 2
    assert len(np.unique(ground_of(viewer, image)[1], axis=0)) > 20


def test_any_movement_ends_the_refinement(open_viewer):
    page = open_viewer("left=thesis&right=thesis&sun=5", width=1280, height=800)
    page.locator(".rate", has_text="Refining").wait_for()
    light = settled(page)["light"]
    page.locator(".dome").focus()
    page.keyboard.press("ArrowRight")
    assert settled(page)["light"] != light
    page.locator(".rate", has_text="Refining").wait_for()
    assert page.locator("#viewer").get_attribute("data-refined") == "false"


def test_divider_moves_over_refined_pictures(open_viewer):
    """Nothing is drawn anew but the picture."""
    page = open_viewer("left=no_shadow&right=map_64")
    refined(page)
    rows = drawn(page)
    page.locator(".over").focus()
    page.keyboard.press("End")
    refined(page)
    page.keyboard.press("Home")
    page.keyboard.press("PageUp")
    for _ in range(4):
        page.keyboard.press("PageUp")
    assert refined(page)["divider"] == "50.0"
    assert np.array_equal(drawn(page), rows)


def test_sun_of_no_size_is_as_before(open_viewer):
    page = open_viewer("left=pcss_256&right=reference")
    refined(page)
    before = drawn(page)
    page.locator("input.sun").fill("2")
    assert refined(page)["sun"] == "2" and np.abs(drawn(page).astype(int) - before).max() > 20
    page.locator("input.sun").fill("0")
    refined(page)
    assert np.array_equal(drawn(page), before)


def test_hint_goes_with_the_first_drag(open_viewer):
    page = open_viewer("right=no_shadow&left=map_64")
    assert page.locator(".hint").is_visible()
    page.locator(".dome").click()
    assert not page.locator(".hint").is_visible()


def test_views_have_names(open_viewer):
    names = (
        open_viewer("left=no_shadow&right=no_shadow")
        .locator("select.view option")
        .all_inner_texts()
    )
    assert names == ["Whole object", "Shadow view 1", "Surface view 1"]


def give(page, name, content):
    page.locator(".file").set_input_files({"name": name, "mimeType": "", "buffer": content})


@pytest.fixture(scope="module")
def other():
    """A mesh elsewhere and of another size, as the viewer should place it, and its frame."""
    shape = bumpy_sphere(3)
    shape.apply_scale([1.0, 0.6, 0.8])
    placed = shape.copy()
    placed.vertices -= placed.bounds.mean(axis=0)
    placed.vertices /= np.linalg.norm(placed.vertices, axis=1).max()
    view = looking((2, 1.5, 2.5), unit(0.3, 0.8, 0.5), fov=40)
    frame = render_gbuffer(scene_of(placed), view, *SIZE)
    shape.vertices = 70 * shape.vertices + [500, -20, 3000]
    return shape, scene_of(placed), frame


def test_mesh_of_one_s_own_is_shown(open_viewer, other):
    shape, scene, frame = other
    page = open_viewer("left=field&right=thesis")
    settled(page)
    expected = np.full(PIXELS, -1.0)
    expected[frame.pixel] = classic_method("ray_traced", scene)(frame)(0.0)
    files = {
        "a.obj": {"file_type": "obj"},
        "b.PLY": {"file_type": "ply"},
        "c.ply": {"file_type": "ply", "encoding": "ascii"},
        "d.stl": {"file_type": "stl"},
        "e.stl": {"file_type": "stl_ascii"},
    }
    contents = {name: shape.export(**settings) for name, settings in files.items()}
    contents["f.ply"] = contents["b.PLY"].replace(
        b"\nelement", "\ncomment Blöcke\nelement".encode(), 1
    )
    for name, content in contents.items():
        give(page, name, content.encode() if isinstance(content, str) else content)
        page.locator(".notice", has_text=f"{name}: {len(shape.faces):,} triangles.").wait_for()
        assert page.locator("h1").inner_text() == f"Shadows of {name}"
        assert np.mean(np.abs(asked(page, "reference", frame) - expected) > 0.5) < 0.004, name
    assert page.locator("select.left").input_value() == "map_256"
    assert page.locator("select.left option[value=field]").is_disabled()
    assert "off" in page.locator(".notice").inner_text() and faults(page) == []
    before = drawn(page)
    page.locator("select.up").select_option("z")
    refined(page)
    assert not np.array_equal(drawn(page), before)


@pytest.mark.parametrize(
    "name, content, reason",
    [
        ("a.glb", b"glTF", "OBJ, PLY or STL"),
        ("a.obj", b"v 0 0 0\nv 1 0 0\n", "no triangles"),
        ("a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 x\nf 1 2 3\n", "no number"),
        ("a.obj", b"v 0 0 0\nf 1 2 3\n", "not there"),
        ("a.ply", b"plymouth", "no header"),
        ("a.stl", b"", "no triangles"),
    ],
)
def test_what_is_no_mesh_is_refused_in_a_sentence(open_viewer, name, content, reason):
    page = open_viewer("left=map_64&right=no_shadow")
    give(page, name, content)
    page.locator(".notice", has_text=reason).wait_for()
    assert page.locator(".notice").inner_text().endswith(".")
    assert page.locator("select.left").input_value() == "map_64" and faults(page) == []


def test_huge_mesh_is_merged_on_a_grid(open_viewer):
    page = open_viewer("left=map_64&right=no_shadow", width=375)
    give(page, "hills.ply", hills(460).export(file_type="ply"))
    page.locator(".notice", has_text="423,200 triangles, merged to").wait_for()
    count = page.locator(".notice").inner_text().partition("merged to ")[2].partition(" ")[0]
    assert 200_000 < int(count.replace(",", "")) <= 400_000
    shape = hills(120)
    mesh = {"vertices": shape.vertices.ravel().tolist(), "faces": shape.faces.ravel().tolist()}
    small = page.evaluate("(mesh) => clustered(mesh, 40)", mesh)
    vertices, faces = (np.reshape(small[key], (-1, 3)) for key in ("vertices", "faces"))
    assert 2000 < len(faces) < 5000
    # Nothing is lost but the rim's halves of cells.
    merged = trimesh.Trimesh(vertices, faces, process=False)
    assert merged.area == pytest.approx(shape.area, rel=0.08)


@pytest.mark.parametrize("width", [375, 1280])
def test_page_never_scrolls_sideways_and_its_text_can_be_read(open_viewer, width):
    page = open_viewer("right=no_shadow&left=map_64&sun=2", width=width, height=667)
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    sizes = "[...document.querySelectorAll('body *')].map((e) => parseFloat(getComputedStyle(e).fontSize))"
    assert min(page.evaluate(sizes)) >= 12
    assert page.locator("canvas").bounding_box()["height"] >= 200


def test_without_webgl_there_is_a_poster_and_the_reason(open_viewer, launch):
    page = open_viewer(browser=launch("--disable-gpu", "--disable-3d-apis"))
    assert "no WebGL2" in page.locator(".reason").inner_text()
    assert page.locator(".poster").is_visible() and not page.locator("canvas").is_visible()
    assert faults(page) == []


REFUSE = """const given = WebGL2RenderingContext.prototype.getExtension;
WebGL2RenderingContext.prototype.getExtension = function (name) {
  return FORBIDDEN.test(name) ? null : given.call(this, name);
};"""


def test_half_floats_are_enough(open_viewer, frames):
    """Most phones draw no others."""
    half = REFUSE.replace("FORBIDDEN", "/buffer_float/")
    pages = [open_viewer("left=no_shadow&right=no_shadow", script=script) for script in ("", half)]
    for key, sun in (("reference", 2.0), ("field", 2.0), ("map_256", 0.0)):
        whole, halves = (asked(page, key, frames[0], sun) for page in pages)
        assert np.array_equal(whole, halves), key
    assert faults(pages[1]) == []


def test_without_floats_there_is_a_poster_and_the_reason(open_viewer):
    page = open_viewer(script=REFUSE.replace("FORBIDDEN", "/buffer/"))
    assert "cannot draw floating-point numbers" in page.locator(".reason").inner_text()


def test_lost_context_leaves_the_poster_and_a_sentence(open_viewer):
    page = open_viewer("right=no_shadow&left=map_64")
    settled(page)
    lose = (
        "document.querySelector('canvas').getContext('webgl2').getExtension('WEBGL_lose_context')"
    )
    page.evaluate(f"{lose}.loseContext()")
    page.locator("#viewer.failed").wait_for()
    assert "Load it anew" in page.locator(".reason").inner_text()
    assert page.locator(".poster").is_visible() and not page.locator("canvas").is_visible()
