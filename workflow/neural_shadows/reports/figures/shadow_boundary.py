"""The boundary of the shadow along a ray (figure 3.2)."""

from pathlib import Path
from typing import Literal

import numpy as np
from pydantic import Field

from neural_shadows.evaluation.look import BLUE, ORANGE
from neural_shadows.reports.drawing.style import GRID, Figure, legend_below
from neural_shadows.sections.scene_figures import SceneFigure
from neural_shadows.settings.records import SceneSettings


class Settings(SceneFigure):
    """A light's rays and their bounds [figure 3.2]."""

    kind: Literal["shadow_boundary"] = Field(description="`shadow_boundary`")


def draw(mesh_ply: Path, mesh_json: Path, title: str, scene: SceneSettings) -> Figure:
    """Draw a light's rays, and their bounds over the offset."""
    from neural_shadows.reports.drawing import drawing
    from neural_shadows.reports.drawing.mesh_slice import slice_rays

    cut, figure = drawing.open_figure(mesh_ply, mesh_json, scene, title)
    plane, graph = figure.subplots(1, 2)
    drawing.draw_disk(plane, "the slice, lit from the upper left")
    rays = slice_rays(cut, 1200)
    hit, end = rays.hit, rays.end
    parts = (
        (rays.t_lb, end, BLUE, "between first and second hit: t$_s$ may lie anywhere"),
        (end, rays.chord, drawing.SHADE, "in shadow"),
    )
    for begin, stop, colour, label in parts:
        lines = rays.at(begin)[hit], rays.at(stop)[hit]
        drawing.draw_segments(plane, *lines, colors=colour, linewidths=0.5, rasterized=True)
        stop = np.where(hit, stop, begin)
        graph.fill_between(rays.offset, begin, stop, color=colour, lw=0, label=label)
    drawing.draw_outline(plane, cut)
    sparse = slice_rays(cut, 12)
    drawing.draw_segments(plane, sparse.at(0 * sparse.t_lb), sparse.at(sparse.t_lb), colors=ORANGE)
    graph.plot(rays.offset, rays.chord, color=ORANGE, label="bounding sphere and light")
    graph.set(xlabel="offset of the ray across the light", ylabel="depth t along the ray")
    graph.set_title("the same by depth: a boundary t$_s$ within the blue is correct", fontsize=11)
    graph.grid(**GRID)
    legend_below(figure)
    return figure
