"""The shader of workflow/field and its sample in a real browser: Python's answers for a million rays."""

import base64
import shutil
from pathlib import Path

import numpy as np
import pytest
import trimesh
from served import served
from shapes import bumpy_sphere, hills

from neural_shadows import ShadowField

WORKFLOW = Path(__file__).parents[2] / "workflow"
TO_SUN = [1.0, 0.4, 0.3]
RAYS = {"solid": 1_000_000, "sheet": 200_000}
ASK = """async ([url, points]) => {
  const bytes = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0)).buffer;
  const field = readField(await (await fetch(url)).arrayBuffer());
  const dark = occluded(await loadShader(), field, new Float32Array(bytes(points)), [1, 0.4, 0.3]);
  let text = "";
  for (let i = 0; i < dark.length; i += 8192) text += String.fromCharCode(...dark.subarray(i, i + 8192));
  return btoa(text);
}"""


def shape_of(name: str) -> trimesh.Trimesh:
    return bumpy_sphere(5) if name == "solid" else hills()


@pytest.fixture
def page(browser, tmp_path):
    """The sample, with room for fields beside it."""
    for folder in ("field", "report/viewer/shaders"):
        shutil.copytree(WORKFLOW / folder, tmp_path / folder)
    with served(tmp_path) as address:
        page = browser.new_page(viewport={"width": 700, "height": 800})
        page.faults = []
        page.on("pageerror", lambda error: page.faults.append(str(error)))
        page.on("console", lambda message: page.faults.append(message.text))
        page.goto(f"{address}field/sample.html")
        yield page
        page.close()


@pytest.mark.parametrize("name", ["solid", "sheet"])
def test_a_million_rays(page, tmp_path, name):
    shape = shape_of(name)
    shape.vertices = 20 * shape.vertices + [100.0, -3.0, 7.0]
    field = ShadowField.fit(shape, resolution=128)
    field.save(tmp_path / "some.field")
    rng = np.random.default_rng(0)
    points = rng.uniform(-1.2, 1.2, (RAYS[name], 3)) * field.radius + field.centre
    points = points.astype(np.float32)
    text = page.evaluate(ASK, ["../some.field", base64.b64encode(points.tobytes()).decode()])
    answers = np.frombuffer(base64.b64decode(text), np.uint8).astype(bool)
    expected = field.occluded(points, TO_SUN)
    assert 0.05 < expected.mean() < 0.6 and np.mean(answers != expected) < 0.001
    assert [fault for fault in page.faults if "ReadPixels" not in fault] == []


def test_the_sample_shows_a_shadow_that_follows_the_sun(page, tmp_path):
    ShadowField.fit(trimesh.creation.icosphere(4), resolution=64).save(tmp_path / "ball.field")
    page.set_input_files("#file", tmp_path / "ball.field")
    page.locator("#words:has-text('a solid')").wait_for()
    # A ball's shadow is an ellipse whose middle is a radius' height times the sun's slope away.
    for place in ([0.5, 0.5], [0.65, 0.5], [0.5, 0.4]):
        box = page.locator("canvas").bounding_box()
        where = [box["x"] + place[0] * box["width"], box["y"] + place[1] * box["height"]]
        page.mouse.move(*where)
        page.mouse.down()
        page.mouse.move(where[0] + 1e-3, where[1])
        page.mouse.up()
        picture = drawn(page)
        rows, columns = np.nonzero(picture == 0)
        slope = np.array([2 * place[0] - 1, 1 - 2 * place[1]]) / 0.6
        area = np.pi * np.sqrt(1 + slope @ slope) * 128**2
        assert len(rows) == pytest.approx(area, rel=0.02)
        middle = np.array([columns.mean(), rows.mean()]) / 128 - 2
        assert middle == pytest.approx(-slope, abs=0.02)
    assert page.faults == []


def drawn(page) -> np.ndarray:
    """Reds of the canvas, rows from below."""
    text = page.evaluate("""() => {
      show();
      const { gl } = shown, pixels = new Uint8Array(4 * 512 * 512);
      gl.readPixels(0, 0, 512, 512, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
      let text = "";
      for (let i = 0; i < pixels.length; i += 8192) text += String.fromCharCode(...pixels.subarray(i, i + 8192));
      return btoa(text);
    }""")
    return np.frombuffer(base64.b64decode(text), np.uint8).reshape(512, 512, 4)[..., 0]


def test_other_files_are_refused_in_one_line(page, tmp_path):
    ShadowField.fit(trimesh.creation.box(), resolution=32).save(tmp_path / "box.field")
    content = (tmp_path / "box.field").read_bytes()
    wrong = {"cut": content[:-100], "empty": b"", "other": b"\xff" * 50}
    wrong |= {"later": content.replace(b"ShadowField 1", b"ShadowField 2")}
    for name, data in wrong.items():
        (tmp_path / name).write_bytes(data)
        page.locator("#words").evaluate("element => element.textContent = ''")
        page.set_input_files("#file", tmp_path / name)
        page.locator("#words:not(:empty)").wait_for()
        assert "Choose a file of ShadowField.save" in page.locator("#words").text_content()
