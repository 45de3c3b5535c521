"""Initial views of a viewer, and its still image."""

from dataclasses import replace
from typing import Any

import numpy as np
from PIL import Image

from neural_shadows.rendering.exact_shadow import exact_visibility
from neural_shadows.rendering.gbuffer import render_gbuffer
from neural_shadows.rendering.shading import shade
from neural_shadows.rendering.viewpoints import draw_viewpoints
from neural_shadows.reports.drawing.hero_view import hero_view
from neural_shadows.scenes.cameras import Viewpoint
from neural_shadows.scenes.lights import arc_directions
from neural_shadows.scenes.scene import Scene
from neural_shadows.settings.records import ViewSettings
from neural_shadows.viewer.template import shown_view

POSTER = (960, 640)  # pixels


def shown_views(scene: Scene, frames: ViewSettings, count: int) -> list[dict[str, Any]]:
    """The whole object, and `count` viewpoints per view set.

    Args:
        frames: `width` and `height`, and settings of `draw_viewpoints`.
    """
    aspect = frames["width"] / frames["height"]
    sets, seed, least = frames["view_sets"], frames["seed"], frames.get("least_shadow", 0.0)
    drawn = draw_viewpoints(scene, sets, range(count), aspect, seed, least)
    named = {"Whole object": _hero_view(scene)}
    named |= {f"{view.view_set.capitalize()} view {view.index + 1}": view for view in drawn}
    return [shown_view(name, view, view.light) for name, view in named.items()]


def poster(scene: Scene) -> Image.Image:
    """Still of the whole object with exact shadow, 2 × 2 antialiased."""
    width, height = (2 * size for size in POSTER)
    frame = render_gbuffer(scene, _hero_view(scene), width, height)
    picture = shade(frame, exact_visibility(scene.tracer, frame))
    image = Image.fromarray(np.round(255 * picture).astype(np.uint8))
    return image.resize(POSTER, Image.Resampling.BOX)


def _hero_view(scene: Scene) -> Viewpoint:
    """The hero view; on an arc, the light is 45° from zenith."""
    view, (light,) = hero_view(scene.up), scene.lights
    if light["domain"] != "single_axis":
        return view
    return replace(view, light=arc_directions(light, scene.up, -np.pi / 4))
