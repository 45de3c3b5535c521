"""Soft shadows on one thread: classic methods on a frame of 2048 × 1024, denoisers' filters alone,
the exact shadow and a frame's buffers.
"""

from functools import partial

import numpy as np
from measurement import Row, median_seconds

from neural_shadows.evaluation.method import visibility
from neural_shadows.evaluation.method_parts.denoisers import BY_KEY
from neural_shadows.evaluation.methods.denoised import DENOISERS
from neural_shadows.evaluation.registry import LABELS, METHODS
from neural_shadows.frames.draw_settings import FrameKind, draw_setting, light_map_of
from neural_shadows.frames.draw_twins import twin_of
from neural_shadows.frames.render_frame import render_buffers, render_target
from neural_shadows.frames.soft_frame import SoftFrame
from neural_shadows.frames.soft_scene import SoftScene
from neural_shadows.rendering.surface import see_surface

SCENE = {"generate": "room", "seed": 2026, "inserted": {}}
RADIUS = 0.125  # metres
TRACED = "a ray a texel"
MEASURED = ("hard", "pcf_9", "pcf_disc", "pcss", "pcss_post", "vsm_9", "msm_9", "msm_15")
MEASURED += ("rt_1", "rt_2", "rt_2_ffx", "rt_2_sigma_ffx")
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
    works = {}
    for key in MEASURED:
        method = METHODS[key]
        constants = {name: values[-1] for name, values in method.constants.items()}
        constants |= {"texels": 4.0} if key == "pcf_disc" else {}
        works[key] = partial(visibility, method, frame, RADIUS, constants)
    stage = f"soft shadow of {width} x {height}: "
    result = [
        Row(stage + LABELS[key], "cpu x1", 1 / seconds, "frames/s")
        for key, seconds in median_seconds(works, rounds).items()
    ]
    works = {
        "map": lambda: SoftFrame(frame.scene, frame.surface, frame.centre, frame.light_map).depths,
        TRACED: lambda: frame.light_map.depths(frame.scene.tracer),
    }
    rate = {name: 1 / value for name, value in median_seconds(works, rounds).items()}
    stage = f"light's map of {frame.light_map.resolution}²"
    traced = {"peer": TRACED, "peer_rate": rate[TRACED]}
    return [*result, Row(stage, "cpu x1", rate["map"], "maps/s", **traced)]


def filters(frame: SoftFrame, rounds: int) -> list[Row]:
    """Pictures of one ray a pixel that each denoiser smooths a second, alone, without the rays."""
    pictures = {key: one.pictures(frame, RADIUS, 1) for key, one in BY_KEY.items()}

    def smooth(key: str) -> None:
        # Copies: of the picture before, some have only what their settings do not share to compute.
        BY_KEY[key].single(*map(np.copy, pictures[key]), frame.surface)

    works = {key: partial(smooth, key) for key in BY_KEY}
    rate = {key: 1 / seconds for key, seconds in median_seconds(works, 3 * rounds).items()}
    stage = f"filter of {frame.surface.width} x {frame.surface.height}: "
    return [
        Row(stage + DENOISERS[key].label, "cpu x1", value, "frames/s")
        for key, value in rate.items()
    ]


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
    result = []
    for name, (kind, twins, radii) in kinds.items():
        rng = np.random.default_rng(1)
        settings = [draw_setting(scene, kind, rng)]
        settings += [twin_of(scene, kind, settings[0], TWINS, rng) for _ in range(twins)]

        def buffers(kind=kind, settings=settings):
            for setting in settings:
                render_buffers(scene, kind, setting)

        def target(kind=kind, settings=settings, radii=radii):
            render_target(scene, kind, settings[0], radii=radii, samples=4, blur=0)

        for part, seconds in median_seconds({"buffers": buffers, "target": target}, rounds).items():
            result.append(Row(f"{name}: {part}", "cpu x1", seconds, "s"))
    return result


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
