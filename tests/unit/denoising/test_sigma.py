"""The SIGMA-like filter beside its formulas, a pixel at a time."""

import numpy as np
import pytest
from filtered_walls import PIXEL, seen_by_sigma

from neural_shadows.denoising.sigma import SigmaFilter

SIZE = (24, 30)


def written_pass(light, share, width, place, normal, reach, alone, turn):
    """One pass in float64."""
    height, columns = light.shape
    after = light.copy(), share.copy(), width.copy()

    def planar(y, x, v, u):
        away = abs(np.dot(normal[y, x], place[v, u] - place[y, x]))
        return max(0.0, 1 - away / (2 * PIXEL)) * max(0.0, np.dot(normal[y, x], normal[v, u]))

    for y, x in np.ndindex(height, columns):
        total = lights = shares = widths = 0.0
        for v in range(max(0, y - 2), min(height, y + 3)):
            for u in range(max(0, x - 2), min(columns, x + 3)):
                part = np.exp(-0.66 * ((v - y) ** 2 + (u - x) ** 2) / 4) * planar(y, x, v, u)
                total, lights = total + part, lights + part * light[v, u]
                shares, widths = shares + part * share[v, u], widths + part * width[v, u]
        dense = lights / total
        if shares == 0:
            after[0][y, x] = dense if alone else light[y, x]
            continue
        penumbra = widths / shares
        radius = reach * penumbra / PIXEL
        t = min(radius / 2, 1)
        total = 8.0
        lights = total * (light[y, x] + t * t * (3 - 2 * t) * (dense - light[y, x]))
        shares = total * PIXEL / (PIXEL + penumbra)
        widths = shares * penumbra
        noise = (0.06711056 * (x + 5.588238 * turn) + 0.00583715 * (y + 5.588238 * turn)) % 1
        angle = 2 * np.pi * (52.9829189 * noise % 1)
        for k in range(12):
            r = np.sqrt((k + 0.5) / 12)
            at = angle + k * np.pi * (3 - 5**0.5)
            u = int(np.floor(x + 0.5 + min(radius, 32) * r * np.cos(at)))
            v = int(np.floor(y + 0.5 + min(radius, 32) * r * np.sin(at)))
            if not (0 <= u < columns and 0 <= v < height):
                continue
            part = np.exp(-0.66 * r * r) * planar(y, x, v, u)
            if share[v, u] > 0:
                part *= min(1, width[v, u] / share[v, u] / penumbra)
            total, lights = total + part, lights + part * light[v, u]
            shares, widths = shares + part * share[v, u], widths + part * width[v, u]
        for image, value in zip(after, (lights, shares, widths)):
            image[y, x] = value / total
    return after


@pytest.mark.parametrize("alone", [True, False])
def test_both_passes_are_as_written(alone):
    rng = np.random.default_rng(0)
    light = rng.integers(0, 5, SIZE).astype(np.float32) / 4
    penumbra = np.float32(rng.uniform(0.2, 9, SIZE) * PIXEL)
    penumbra[light == 1] = -1
    depth = np.float32(2 + 0.3 * PIXEL * np.arange(SIZE[1]) + np.zeros(SIZE))
    depth[:, 20:] += np.float32(1.2 * PIXEL)
    normal = np.zeros((*SIZE, 3), np.float32)
    normal[..., 0], normal[..., 1], normal[..., 2] = -0.3, rng.choice([0, 0.5, 3], SIZE), 1
    normal /= np.linalg.norm(normal, axis=2, keepdims=True)
    light[:6, :8], penumbra[:6, :8] = 0, -1  # turned from the light: no blocker
    filter_ = seen_by_sigma(SigmaFilter(*SIZE, reach=0.8, alone=alone), depth, normal)
    found = filter_.smooth(light, penumbra, turned=3)
    rows, columns = np.mgrid[: SIZE[0], : SIZE[1]] * PIXEL
    place = np.stack([columns, rows, depth], axis=2).astype(np.float32).astype(float)
    share = np.where(penumbra < 0, 0, PIXEL / (PIXEL + penumbra.astype(float)))
    images = light.astype(float), share, share * penumbra
    for turn in (6, 7):
        images = written_pass(*images, place, normal.astype(float), 0.8, alone, turn)
    assert np.abs(images[0] - light).mean() > 0.1
    # A tap on a pixel's border may fall on its other side.
    assert np.mean(np.abs(found - images[0]) > 1e-4) < 0.005
