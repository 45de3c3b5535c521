"""Soft shadows on one thread: classic methods on a frame of 2048 × 1024, beside plain numpy forms;
the exact shadow and a frame's buffers.
"""

from collections.abc import Callable
from functools import partial

import numpy as np
from measurement import Row, median_seconds

from neural_shadows.evaluation.method_parts.denoisers import BY_KEY
from neural_shadows.evaluation.soft_methods.denoised import DENOISERS
from neural_shadows.evaluation.soft_registry import LABELS, soft_method
from neural_shadows.frames.draw_settings import FrameKind, draw_setting, light_map_of
from neural_shadows.frames.draw_twins import twin_of
from neural_shadows.frames.render_frame import render_buffers, render_target
from neural_shadows.frames.soft_frame import SoftFrame
from neural_shadows.frames.soft_scene import SoftScene
from neural_shadows.rendering.surface import see_surface
from neural_shadows.shadow_maps.light_map import LightMap
from neural_shadows.shadow_maps.moments import MOMENT_BIAS, box

SCENE = {"generate": "room", "seed": 2026, "inserted": {}}
RADIUS = 0.125  # metres
NUMPY, TRACED = "plain numpy", "a ray a texel"
GOLDEN_ANGLE = np.pi * (3 - 5**0.5)
TWINS = {"light": 0.007, "eye": 0.0013, "turn_deg": 0.0}


def rows(quick: bool) -> list[Row]:
    """Frames a second of each method, and seconds of what a frame set is made of."""
    scene = SoftScene(SCENE, [])
    frame = _frame(scene, 1024 if quick else 2048)
    rounds = 1 if quick else 3
    return [*methods(frame, rounds), *filters(_frame(scene, 512), rounds), *frames(scene, rounds)]


def methods(frame: SoftFrame, rounds: int) -> list[Row]:
    """Whole frames a second, without the map; and the map rasterised and traced."""
    width, height = frame.surface.width, frame.surface.height
    found, size = [], f"{width} x {height}"
    peers: dict[str, Callable[[], object]] = {
        "pcf_disc": partial(numpy_disc, frame, 4.0),
        "pcss": partial(numpy_pcss, frame),
        "msm_9": partial(numpy_moments, frame),
    }
    for key in (
        "hard",
        "pcf_9",
        "pcf_disc",
        "pcss",
        "pcss_post",
        "vsm_9",
        "msm_9",
        "msm_15",
        "rt_1",
        "rt_2",
        "rt_2_ffx",
        "rt_2_sigma_ffx",
    ):
        method = soft_method(key)
        constants = method.settings()[-1] | ({"texels": 4.0} if key == "pcf_disc" else {})
        works = {key: partial(method.answer, frame, RADIUS, **constants)}
        if key in peers:
            works[NUMPY] = peers[key]
        rate = {name: 1 / value for name, value in median_seconds(works, rounds).items()}
        told = {"peer": NUMPY, "peer_rate": rate[NUMPY]} if key in peers else {}
        stage = f"soft shadow of {size}: {LABELS[key]}"
        found.append(Row(stage, "cpu x1", rate[key], "frames/s", **told))
    works = {
        "map": lambda: SoftFrame(frame.scene, frame.surface, frame.centre, frame.light_map).depths,
        TRACED: lambda: frame.light_map.depths(frame.scene.tracer),
    }
    rate = {name: 1 / value for name, value in median_seconds(works, rounds).items()}
    stage = f"light's map of {frame.light_map.resolution}²"
    told = {"peer": TRACED, "peer_rate": rate[TRACED]}
    return [*found, Row(stage, "cpu x1", rate["map"], "maps/s", **told)]


def filters(frame: SoftFrame, rounds: int) -> list[Row]:
    """Pictures of one ray a pixel that each denoiser smooths a second, alone, without the rays."""
    works = {
        key: partial(denoiser.single, *denoiser.pictures(frame, RADIUS, 1), frame.surface)
        for key, denoiser in BY_KEY.items()
    }
    rate = {key: 1 / seconds for key, seconds in median_seconds(works, 3 * rounds).items()}
    size, found = f"{frame.surface.width} x {frame.surface.height}", []
    for key, value in rate.items():
        peer = "oidn" if key.startswith("oidn") else "svgf"
        stage, named = (f"filter of {size}: {DENOISERS[one].label}" for one in (key, peer))
        told = {} if key == peer else {"peer": named, "peer_rate": rate[peer]}
        found.append(Row(stage, "cpu x1", value, "frames/s", **told))
    return found


def frames(scene: SoftScene, rounds: int) -> list[Row]:
    """Frames of 512 × 256 with three twins and five radii, windows of 256² with one and six."""
    size = scene.at_rest.size
    picture = {"kind": "perspective", "fov": 120, "resolution": 512}
    cube = {"kind": "cube", "resolution": 2048}
    kinds = {
        "frame of 512 x 256, 3 twins": (
            FrameKind(512, 256, 55, None, picture, 0.25),
            3,
            [k / 16 for k in range(5)],
        ),
        "window of 256 x 256, 1 twin": (
            FrameKind(256, 256, 55, (2048, 1024), cube, 0.00625 * size),
            1,
            [0.00125 * k * size for k in range(6)],
        ),
    }
    found = []
    for name, (kind, twins, radii) in kinds.items():
        rng = np.random.default_rng(1)
        settings = [draw_setting(scene, kind, rng)]
        settings += [twin_of(scene, kind, settings[0], TWINS, rng) for _ in range(twins)]

        def buffers(kind=kind, settings=settings):
            for one in settings:
                render_buffers(scene, kind, one)

        def target(kind=kind, settings=settings, radii=radii):
            render_target(scene, kind, settings[0], radii=radii, samples=4, blur=0)

        for part, seconds in median_seconds({"buffers": buffers, "target": target}, rounds).items():
            found.append(Row(f"{name}: {part}", "cpu x1", seconds, "s"))
    return found


def _frame(scene: SoftScene, width: int) -> SoftFrame:
    settings = {"kind": "perspective", "fov": 120, "resolution": width}
    kind = FrameKind(width, width // 2, 55, None, settings, 0.25)
    setting = draw_setting(scene, kind, np.random.default_rng(2))
    surface = see_surface(scene.at_rest, setting.camera, kind.width, kind.height)
    light_map = light_map_of(settings, scene, setting.centre)
    frame = SoftFrame(scene.at_rest, surface, setting.centre, light_map)
    for name in ("from_light", "cosines", "bias", "starts", "depths"):
        getattr(frame, name)
    return frame


def numpy_disc(frame: SoftFrame, texels: float, samples: int = 128) -> np.ndarray:
    """Percentage-closer filtering over a disc, a sample of all pixels at a time."""
    angle = texels * 2 * frame.light_map.half / frame.light_map.resolution
    return _lit_share(frame, np.full(len(frame.from_light), angle), samples)


def numpy_pcss(frame: SoftFrame, searched: int = 64, samples: int = 128) -> np.ndarray:
    """Percentage-closer soft shadows likewise."""
    distance = np.linalg.norm(frame.from_light, axis=1)
    total, count = np.zeros((2, len(distance)))
    for texels in _looked_up(frame, RADIUS * 3 / distance, searched):
        depth = np.where(texels < 0, np.inf, frame.depths[texels])
        blocks = distance > depth + frame.bias
        total += np.where(blocks, depth, 0)
        count += blocks
    mean = total / np.maximum(count, 1)
    angles = RADIUS * (distance - mean) / (distance * np.maximum(mean, 1e-9))
    return np.where(count > 0, _lit_share(frame, angles, samples), 1)


def _lit_share(frame: SoftFrame, angles: np.ndarray, samples: int) -> np.ndarray:
    distance, lit = np.linalg.norm(frame.from_light, axis=1), 0
    for texels in _looked_up(frame, angles, samples):
        first = np.where(texels < 0, np.inf, frame.depths[texels])
        lit = lit + (distance <= first + frame.bias)
    return lit / samples


def _looked_up(frame: SoftFrame, angles: np.ndarray, samples: int):
    """Texels of each sample of a disc of directions round each point's; −1 off a map of one face."""
    forward = frame.from_light / np.linalg.norm(frame.from_light, axis=1, keepdims=True)
    right = np.cross(forward, np.array([0.3, 0.5, 0.8], np.float32))
    right /= np.linalg.norm(right, axis=1, keepdims=True)
    down = np.cross(forward, right)
    face = frame.light_map.faces[0].astype(np.float32)
    middle, *across = (face @ one.T for one in (forward, right, down))  # as the map has its axes
    for k in range(samples):
        radius = (np.sqrt((k + 0.5) / samples) * angles).astype(np.float32)
        turn = np.float32(k * GOLDEN_ANGLE)
        way = middle + radius * (np.cos(turn) * across[0] + np.sin(turn) * across[1])
        yield _numpy_texels(frame.light_map, way)


def _numpy_texels(light_map: LightMap, way: np.ndarray) -> np.ndarray:
    """Texels in a map of one face, −1 off it, by directions (3, n) right, down and forward in it."""
    size = light_map.resolution
    scale = np.float32(0.5 * size / light_map.half) / way[2]
    column, row = (np.floor(way[k] * scale + np.float32(size / 2)) for k in (0, 1))
    inside = (way[2] > 0) & (column >= 0) & (column < size) & (row >= 0) & (row < size)
    return np.where(inside, row * np.float32(size) + column, -1).astype(np.int64)


def numpy_moments(frame: SoftFrame) -> np.ndarray:
    """Four moments of 9 × 9 texels, nearest look-up, and each pixel's system by numpy.linalg."""
    size, far = frame.light_map.resolution, 2 * frame.scene.size
    q = np.minimum(frame.depths, far).reshape(size, size) / far
    kernel, moments = box(9), q[..., None] ** np.arange(1, 5)
    for axis in (0, 1):
        moments = np.apply_along_axis(np.convolve, axis, moments, kernel, "same")
    texels = np.maximum(
        _numpy_texels(frame.light_map, frame.light_map.faces[0] @ frame.from_light.T), 0
    )
    b = (1 - MOMENT_BIAS) * moments.reshape(-1, 4)[texels] + MOMENT_BIAS / 2
    z = (np.linalg.norm(frame.from_light, axis=1) - frame.bias) / far
    one = np.ones_like(z)
    rows_ = [[one, b[:, 0], b[:, 1]], [b[:, 0], b[:, 1], b[:, 2]], [b[:, 1], b[:, 2], b[:, 3]]]
    hankel = np.moveaxis(np.array(rows_), -1, 0) + 1e-9 * np.eye(3)
    c = np.linalg.solve(hankel, np.stack([one, z, z * z], axis=-1)[..., None])[..., 0]
    middle, product = -c[:, 1] / (2 * c[:, 2]), c[:, 0] / c[:, 2]
    half = np.sqrt(np.maximum(middle**2 - product, 0))
    near, far_ = middle - half, middle + half
    between = (z * far_ - b[:, 0] * (z + far_) + b[:, 1]) / ((far_ - near) * (z - near))
    behind = 1 - (near * far_ - b[:, 0] * (near + far_) + b[:, 1]) / ((z - near) * (z - far_))
    return 1 - np.clip(np.where(z <= near, 0, np.where(z <= far_, between, behind)), 0, 1)
