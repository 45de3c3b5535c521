"""The method in one picture (figure 3.1)."""

from pathlib import Path
from typing import TYPE_CHECKING, Literal

import numpy as np
from pydantic import Field

from neural_shadows.evaluation.look import BLUE, ORANGE
from neural_shadows.rays.streams import DIRECTIONS
from neural_shadows.reports.drawing.style import Axes, Figure, legend_below
from neural_shadows.sections.scene_figures import SamplingFigure
from neural_shadows.settings.records import SamplingSettings, SceneSettings

if TYPE_CHECKING:
    from neural_shadows.reports.drawing.mesh_slice import MeshSlice


class Settings(SamplingFigure):
    """The method from view directions to a query [figure 3.1]."""

    kind: Literal["overview"] = Field(description="`overview`")


def draw(
    mesh_ply: Path,
    mesh_json: Path,
    title: str,
    scene: SceneSettings,
    sampling: SamplingSettings,
    scene_seed: int,
) -> Figure:
    """Draw directions, silhouette points, labels and a query."""
    from neural_shadows.rays.poisson_disk import sphere_directions
    from neural_shadows.reports.drawing import drawing
    from neural_shadows.reports.drawing.mesh_slice import slice_rays

    cut, figure = drawing.open_figure(mesh_ply, mesh_json, scene, title, 13.3, 4.4)
    directions, points, labels, query = figure.subplots(1, 4)
    pattern = sphere_directions(drawing.SHOWN_DIRECTIONS, (scene_seed, DIRECTIONS))[0]
    drawing.draw_hemisphere(directions, pattern, "a  view directions")
    drawing.draw_disk(points, "b  rays through a silhouette's quadtree")
    shown = drawing.slice_silhouette(cut, sampling)
    shown.draw(points)
    shown.draw_points(points, drawing.SHOWN_POINTS // 3, scene_seed, 2)
    drawing.draw_disk(labels, "c  labels: bounds along the rays")
    drawing.draw_bounded_rays(labels, slice_rays(cut, drawing.FEW_RAYS), 1.0)
    drawing.draw_outline(labels, cut)
    _draw_query(query, cut)
    legend_below(figure)
    return figure


def _draw_query(axes: Axes, cut: "MeshSlice") -> None:
    """Draw a ray with a point in shadow on it."""
    from neural_shadows.reports.drawing import drawing
    from neural_shadows.reports.drawing.mesh_slice import slice_rays

    drawing.draw_disk(axes, "d  a query: p is in shadow, as s > t$_s$")
    drawing.draw_outline(axes, cut)
    rays = slice_rays(cut, 401)
    # The ray with the longest shortest part of those before, in and behind the object.
    parts = np.diff([0 * rays.end, rays.t_lb, rays.end, rays.chord], axis=0)
    i = np.argmax(np.where(rays.hit, parts.min(axis=0), -1))
    o, d = rays.origins[i], rays.direction
    first, last, chord = rays.t_lb[i], rays.end[i], rays.chord[i]
    depth, s = (first + last) / 2, last + 0.6 * (chord - last)
    for begin, stop, colour in ((-0.2, depth, ORANGE), (depth, s, drawing.SHADE)):
        ends = np.stack([o + begin * d, o + stop * d]).T
        axes.plot(*ends, color=colour, linewidth=2, clip_on=False)
    style = {"ha": "center", "va": "center", "color": ORANGE, "annotation_clip": False}
    axes.annotate("light", o - 0.26 * d, **style)
    for t, text, colour in ((0.0, "o", ORANGE), (depth, "t$_s$", BLUE), (s, "p", drawing.OUTLINE)):
        axes.plot(*(o + t * d), "o", color=colour, zorder=4)
        style = {"xytext": (5, 4), "textcoords": "offset points", "fontsize": 12, "zorder": 5}
        axes.annotate(text, o + t * d, **style)
