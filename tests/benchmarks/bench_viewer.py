"""Screen-space networks in a page, in Chromium with WebGL2 in software; beside PyTorch in float32.

A first frame is from the page's data on, and holds all compiling.
"""

import importlib.util
import time
from functools import partial

import torch
from chromium import ARGUMENTS, CHROMIUM
from measurement import Row, median_seconds
from network_page import EXECUTOR, draw, make, open_page, opened, smooth_planes

from neural_shadows.viewer.screen_arrays import screen_arrays, with_half_weights

NETWORKS = ("nsm_layouts", "kernels_enhanced", "kernels_rays")
SIZES = [(128, 256), (256, 512)]  # height, width
DEVICE = "SwiftShader"


def rows(quick: bool) -> list[Row]:
    """Frames a second of each network; none without Chromium and Playwright."""
    if CHROMIUM is None or importlib.util.find_spec("playwright") is None:
        return []
    from playwright.sync_api import sync_playwright

    code = sum(path.stat().st_size for path in EXECUTOR)
    result = [Row("networks in a page: JavaScript and shaders", "", code / 1024, "KiB")]
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=ARGUMENTS)
        for name in NETWORKS:
            result += _rows(browser, name, 3 if quick else 9)
        browser.close()
    return result


def _rows(browser, name: str, rounds: int) -> list[Row]:
    network, header = opened(name)
    data, peer = screen_arrays(network, header), with_half_weights(network)
    size = len(data["arrays"]["weights"]["data"])
    result = [Row(f"{name} in a page: weights, base64", "", size / 1024, "KiB")]
    for height, width in SIZES:
        stage = f"{name} in a page, {width} x {height}, {len(data['plan'])} draws"
        planes = smooth_planes(data["planes"], height, width)
        page, started = open_page(browser), time.perf_counter()
        make(page, data, planes)
        draw(page)
        first = time.perf_counter() - started
        batch = planes[None].contiguous(memory_format=torch.channels_last)
        works = {"page": partial(draw, page), "torch": partial(peer.in_bands, batch)}
        seconds = median_seconds(works, rounds)
        rates = (1 / seconds["page"], "frames/s", None, "PyTorch, float32", 1 / seconds["torch"])
        result += [Row(f"{stage}: first", DEVICE, first, "s"), Row(stage, DEVICE, *rates)]
        page.close()
    return result
