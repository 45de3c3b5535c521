"""Record the README's moving picture: a light moves through the soft viewer, by four methods.

PYTHONPATH=tests python tests/browser/record_light.py reports/viewer_soft.html light.webp

In a software renderer three methods took two minutes for each of its places.
"""

import argparse
import io
import math
from pathlib import Path
from urllib.parse import parse_qs, urlencode

import numpy as np
from chromium import ARGUMENTS, CHROMIUM
from matplotlib import font_manager
from PIL import Image, ImageDraw, ImageFont
from playwright.sync_api import Page, sync_playwright
from tqdm import trange

METHODS = {
    "hard": "Shadow map",
    "cones": "Cones through distance fields",
    "kernels_rays": "A network over two rays a pixel",
    "truth": "Ray traced",
}
PLACES, RADIUS = 14, 0.031  # of the light, m
SIDE, GAP, HEADER, FONT_SIZE = 260, 8, 24, 13  # pixels
STILL = 0.5  # of 255, mean change in 1.5 s
HIDDEN = "#viewer button, .over, .nudge, .rate, .legend, .reason {visibility: hidden !important}"


def record(page: Page) -> list[Image.Image]:
    """Pictures of a light on an ellipse around where it stands, the methods side by side."""
    page.add_style_tag(content=HIDDEN)
    page.select_option("select.detail", "512")
    state = parse_qs(page.evaluate("location.hash")[1:])
    view = {key: values[0] for key, values in state.items()}
    x, y, z = map(float, view["light"].split(","))
    pictures = []
    for place in trange(PLACES, unit="place"):
        angle = 2 * math.pi * place / PLACES
        light = x + 0.55 * math.sin(angle), y, z + 0.1 - 0.45 * math.cos(angle)
        view |= {"light": ",".join(f"{each:.3f}" for each in light), "radius": str(RADIUS)}
        pictures.append(side_by_side(page, view))
    return pictures


def side_by_side(page: Page, view: dict[str, str]) -> Image.Image:
    picture = Image.new("RGB", (len(METHODS) * (SIDE + GAP) - GAP, SIDE + HEADER), "white")
    draw = ImageDraw.Draw(picture)
    font = ImageFont.truetype(font_manager.findfont("DejaVu Sans"), FONT_SIZE)
    for number, (method, label) in enumerate(METHODS.items()):
        whole = view | {"left": method, "right": method, "divider": "100.0"}
        page.evaluate("hash => { location.hash = hash }", urlencode(whole))
        shown = shot_at_rest(page)
        side = min(shown.size)
        left, top = (shown.width - side) // 2, (shown.height - side) // 2
        square = shown.crop((left, top, left + side, top + side))
        picture.paste(square.resize((SIDE, SIDE)), (number * (SIDE + GAP), HEADER))
        draw.text((number * (SIDE + GAP) + 4, 4), label, "black", font)
    return picture


def shot_at_rest(page: Page) -> Image.Image:
    """The canvas, once it hardly changes: rays accumulate for minutes."""
    box = page.locator("canvas").first.bounding_box()
    shots = [np.zeros(1)]
    while len(shots) < 2 or np.abs(shots[-1] - shots[-2]).mean() > STILL:
        page.wait_for_timeout(1500)
        image = Image.open(io.BytesIO(page.screenshot(clip=box))).convert("RGB")
        shots.append(np.asarray(image, np.float32))
    return image


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("viewer", type=Path)
    parser.add_argument("webp", type=Path)
    arguments = parser.parse_args()
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=ARGUMENTS)
        page = browser.new_page(viewport={"width": 1100, "height": 900})
        page.set_default_timeout(300_000)
        page.goto(arguments.viewer.resolve().as_uri())
        page.wait_for_selector("#viewer.ready, #viewer.failed")
        first, *others = record(page)
        browser.close()
    first.save(
        arguments.webp,
        save_all=True,
        append_images=others,
        duration=260,
        loop=0,
        quality=62,
        method=6,
    )


if __name__ == "__main__":
    main()
