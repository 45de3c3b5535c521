"""The soft viewer in a browser, against the pipeline's buffers, maps, rays, filters and networks."""

import base64
import json
import re
from contextlib import contextmanager
from dataclasses import replace
from io import BytesIO

import numpy as np
import pytest
import torch
from PIL import Image
from soft_viewer_page import NETWORKS, frame_of, images_of, make_soft_viewer

from neural_shadows.denoising.ffx import FfxTrials
from neural_shadows.evaluation.method import visibility
from neural_shadows.evaluation.method_parts import scene_fields
from neural_shadows.evaluation.methods import object_cones, pcf, pcss
from neural_shadows.evaluation.registry import METHODS
from neural_shadows.frames.feature_names import FEATURES, TRACED, buffers_of, channels_of
from neural_shadows.frames.features import named_features
from neural_shadows.frames.light_size import light_size
from neural_shadows.frames.ray_tracing import ray_traced, traced_images
from neural_shadows.networks.screen_space.screen_networks import load_screen_network
from neural_shadows.rendering.gbuffer import lens_of
from neural_shadows.representations.shadow_field.shadow_field import PUSH
from neural_shadows.viewer.screen_arrays import with_half_weights
from neural_shadows.viewer.soft_scene_arrays import FIELD_CELL

SIZE = WIDTH, HEIGHT = 512, 256  # in half of it two percent of the pixels are edges
RAYS = 8  # of the reference
SHARES = (0.0, 0.5, 1.0)  # of the largest radius
# Of visibility and features, in steps of 1/255. Rasterisers put corners on a grid of 1/16 (here) to
# 1/256 of a pixel: pixels and texels at edges differ. A filtered map spreads a texel over its taps, which
# in this room of lattices and spokes are up to 1.7 % of the pixels.
MEAN, MOST = 1 / 255, 4 / 255
SHARE, SHARE_OF_FILTERED = 0.99, 0.98
FILTERED = ("pcf", "pcss", "msm")
# In half precision: of kernels, and of a network that predicts visibility itself.
HALF_MAPS = {"kernels": 2e-3, "shuffle": 4e-3}


@pytest.fixture(scope="module")
def soft_page(tmp_path_factory):
    scene = {"generate": "room", "seed": 5, "inserted": {}}
    return make_soft_viewer(tmp_path_factory.mktemp("soft"), scene)


@pytest.fixture(scope="module")
def data(soft_page):
    text = soft_page.html.read_text("utf-8")
    found = re.search(r'<script type="application/json" id="data">(.*?)</script>', text, re.S)
    return json.loads(found[1])


@contextmanager
def opened(browser, html, fragment="", script="", **options):
    """The page, and what its console says. Closed at the end: it refines its picture for minutes.

    A script comes before its own.
    """
    page = browser.new_page(**{"viewport": {"width": 640, "height": 480}} | options)
    said = []
    page.on("console", lambda message: said.append(message.text))
    page.on("pageerror", lambda error: said.append(str(error)))
    page.add_init_script(script)
    page.goto(f"file://{html}#{fragment}")
    page.wait_for_selector("#viewer.ready,#viewer.failed", timeout=120_000)
    yield page, said
    page.close()


@pytest.fixture(scope="module")
def page(browser, soft_page):
    with opened(browser, soft_page.html, "left=hard&right=hard") as (page, _):
        yield page


@pytest.fixture(scope="module")
def frame(soft_page, data):
    return frame_of(soft_page, data["views"][1], SIZE)


def asked(data, share=0.0):
    view = data["views"][1]
    light = {"centre": view["light"], "radius": share * data["radius"]}
    return {
        "view": {key: view[key] for key in ("eye", "target", "fov")},
        "light": light,
        "size": SIZE,
        "truth": RAYS,
    }


def answers(page, key, question):
    shown = page.evaluate("([key, asked]) => viewer.answers(key, asked)", [key, question])
    return np.array(shown, np.float32).reshape(HEIGHT, WIDTH)


def assert_alike(shown, expected, name):
    off = np.abs(np.asarray(shown, float) - expected)
    share = SHARE_OF_FILTERED if any(word in name for word in FILTERED) else SHARE
    assert off.mean() <= MEAN, (name, off.mean())
    assert np.quantile(off, share) <= MOST, (name, np.quantile(off, share))


def test_buffers(page, data, frame):
    """Each buffer but at edges, where a pixel shows another surface."""
    shown = page.evaluate("(asked) => viewer.channels(asked)", asked(data))
    shown = {key: np.array(values).reshape(HEIGHT, WIDTH, 4) for key, values in shown.items()}
    places = {"z": ("lengths", 0), "gap": ("lengths", 1), "d": ("lengths", 2)}
    places |= {"c_e": ("visibilities", 0), "c_v": ("visibilities", 1), "hard": ("visibilities", 2)}
    places |= {"msm": ("visibilities", 3), "pcf": ("pcf", 0)}
    places |= {f"n_{axis}": ("normals", k) for k, axis in enumerate("xyz")}
    expected = images_of(list(places), frame)
    for name, (texture, channel) in places.items():
        assert_alike(shown[texture][..., channel], expected[name], name)


@pytest.mark.parametrize("share", SHARES)
def test_classic_methods(page, data, frame, share):
    """Maps, rays and the filter, with constants of their own."""
    radius = share * data["radius"]
    count = 2 if radius else 1
    rays, even = (
        image(frame, ray_traced(frame, radius, samples=count, even=spread))
        for spread in (False, True)
    )
    # The reference goes on with the sequence of two rays' sets, as their frames do.
    sets = [replace(frame, number=number) for number in range(RAYS // 2)]
    many = np.mean([ray_traced(one, radius, samples=count) for one in sets], axis=0)
    expected = {
        "pcf": image(frame, pcf._box(frame, radius, size=9, bias=1.0)),
        "pcss": image(frame, pcss._visibility(frame, radius, nearest=0.5, scale=1.0, bias=1.0)),
        "msm_9": image(
            frame,
            visibility(METHODS["msm_9"], frame, radius, {"bias": 0.1, "bleeding": 0.1}),
        ),
        "rays_2": rays,
        "rays_4": image(frame, ray_traced(frame, radius, samples=4)),
        "truth": image(frame, many),
        "rays_2_ffx": FfxTrials(HEIGHT, WIDTH).single(even, frame.surface),
    }
    for key, values in expected.items():
        assert_alike(answers(page, key, asked(data, share)), values, key)


@pytest.mark.parametrize("share", SHARES)
def test_cones(page, data, frame, share, monkeypatch):
    """Past fields of the page's cells; of a point, rays through them."""
    monkeypatch.setattr(scene_fields, "CELL", FIELD_CELL)
    scene_fields.fields_of.cache_clear()
    cones = object_cones.cone_traced(frame, share * data["radius"], walks=8, push=PUSH)
    shown = answers(page, "cones", asked(data, share))
    assert_alike(shown, image(frame, cones), "cones")
    scene_fields.fields_of.cache_clear()


def image(frame, visibility):
    """Image of visibilities, dark where the surface is turned from the light."""
    return frame.surface.image((visibility * (frame.cosines > 0)).astype(np.float32), 1.0)


@pytest.mark.parametrize("name", NETWORKS)
@pytest.mark.parametrize("share", SHARES[::2])
def test_networks(page, data, frame, soft_page, name, share):
    """Features as the pipeline's; the answer as the same half-precision network's of these features."""
    network, header = load_screen_network(soft_page.html.parent / name / "weights.safetensors")
    network = with_half_weights(network)
    radius, size = share * data["radius"], soft_page.scene.size
    buffers = images_of([b for b in buffers_of(network.features) if b not in TRACED], frame)
    if header.get("rays"):
        buffers |= zip(TRACED, traced_images(frame, radius, samples=header["rays"]))
    lens = lens_of(frame.surface.camera, *SIZE)
    expected = named_features(
        network.features, buffers, lens, light_size(radius, data["radius"], size)
    )
    shown = answers(page, name, asked(data, share))
    planes = np.array(
        page.evaluate("([key, asked]) => viewer.planes(key, asked)", [name, asked(data)])
    )
    names = [name for name in network.features for _ in range(FEATURES[name])]
    planes = planes.reshape(channels_of(network.features), HEIGHT, WIDTH).astype(np.float32)
    for number, (plane, values) in enumerate(zip(planes, expected, strict=True)):
        spread = max(1.0, float(np.ptp(values)))
        assert_alike(plane / spread, values / spread, f"{name}, {names[number]}")
    with torch.inference_mode():
        whole = network(torch.from_numpy(planes)[None])[0, 0].numpy()
    assert np.abs(shown - whole).max() <= HALF_MAPS[header["network"]["form"]]


@pytest.mark.parametrize("key", ["rays_1", "cones"])
def test_a_motion_moves_shadows_with_their_object(page, data, key):
    """Turned once round, the object casts its shadow as at rest; moved, another, as near to the rays'."""
    question = asked(data, 0.5)
    rest = answers(page, key, question)
    turned = answers(page, key, question | {"move": [0, 0, 2 * np.pi]})
    assert np.mean(np.abs(turned - rest)) < MEAN
    elsewhere = question | {"move": [0.2, 0.1, 0.4]}
    moved, exact = answers(page, key, elsewhere), answers(page, "truth", elsewhere)
    assert np.mean(np.abs(moved - rest)) > MEAN
    near = np.mean(np.abs(rest - answers(page, "truth", question)))
    assert np.mean(np.abs(moved - exact)) < 1.2 * near


def test_a_picture_without_errors(browser, soft_page):
    with opened(browser, soft_page.html, "left=pcss&right=kernels_rays") as (page, said):
        page.wait_for_selector(".rate:not(:empty)", timeout=120_000)
        picture = page.evaluate(
            "() => { viewer.redraw(); return document.querySelector('canvas').toDataURL(); }"
        )
        assert not page.inner_text(".reason")
    assert not [text for text in said if "INVALID" in text or "rror" in text]
    shown = np.array(Image.open(BytesIO(base64.b64decode(picture.split(",")[1]))).convert("L"))
    assert shown.std() > 10  # of 255: neither black nor of one colour


def test_dragging_the_light_moves_it_and_the_address_keeps_it(browser, soft_page):
    with opened(browser, soft_page.html, "left=hard&right=msm_3") as (page, _):
        page.wait_for_selector(".rate:not(:empty)", timeout=120_000)
        before = page.evaluate("() => viewer.state.light.centre")
        box = page.locator(".light").bounding_box()
        x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
        page.mouse.move(x, y)
        page.mouse.down()
        page.mouse.move(x + 40, y + 25, steps=4)
        page.mouse.up()
        page.wait_for_selector("#viewer[data-moving=false]", timeout=120_000)
        after = page.evaluate("() => viewer.state.light.centre")
        page.locator(".over").focus()
        page.keyboard.press("End")
        page.wait_for_function("() => location.hash.includes('divider=100.0')")
        address = page.url.split("#")[1]
    assert np.linalg.norm(np.subtract(after, before)) > 0.02
    with opened(browser, soft_page.html, address) as (page, _):
        assert page.evaluate("() => viewer.state.light.centre") == pytest.approx(after, abs=1e-3)
        assert page.evaluate("() => viewer.state.right") == "msm_3"


def test_a_phone(browser, soft_page):
    with opened(browser, soft_page.html, viewport={"width": 375, "height": 700}) as (page, _):
        page.wait_for_selector(".rate:not(:empty)", timeout=120_000)
        assert page.evaluate("() => document.documentElement.scrollWidth") <= 375
        assert page.locator("canvas").bounding_box()["height"] >= 200


def test_no_method_needs_an_extension(browser, soft_page, page, data):
    """Phones cannot draw floats: a context that is refused extensions gives the same answers."""
    refuse = "WebGL2RenderingContext.prototype.getExtension = () => null;"
    with opened(browser, soft_page.html, "left=hard&right=hard", script=refuse) as (bare, said):
        for key in ("hard", "pcf", "pcss", "msm_9", "rays_2_ffx", "cones", *NETWORKS):
            question = asked(data, 0.5)
            assert np.array_equal(answers(bare, key, question), answers(page, key, question)), key
        assert not bare.inner_text(".reason")
    assert not [text for text in said if "INVALID" in text or "rror" in text]


def test_without_webgl(launch, soft_page):
    with opened(launch("--disable-gpu", "--disable-3d-apis"), soft_page.html) as (page, _):
        assert "no WebGL2" in page.inner_text(".reason")
        assert page.locator(".poster").is_visible()
