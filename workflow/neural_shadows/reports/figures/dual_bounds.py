"""The two bounds of a label (figure 3.5)."""

from pathlib import Path
from typing import Literal

from pydantic import Field

from neural_shadows.reports.drawing.style import Figure, legend_below
from neural_shadows.sections.scene_figures import SceneFigure
from neural_shadows.settings.records import SceneSettings


class Settings(SceneFigure):
    """Rays of a slice, coloured by their bounds [figure 3.5]."""

    kind: Literal["dual_bounds"] = Field(description="`dual_bounds`")


def draw(mesh_ply: Path, mesh_json: Path, title: str, scene: SceneSettings) -> Figure:
    """Draw rays of a slice, coloured by their bounds."""
    from neural_shadows.reports.drawing import drawing
    from neural_shadows.reports.drawing.mesh_slice import slice_rays

    cut, figure = drawing.open_figure(mesh_ply, mesh_json, scene, title)
    disk, detail = figure.subplots(1, 2)
    drawing.draw_disk(disk, f"{drawing.FEW_RAYS} of a light's rays")
    drawing.draw_disk(detail, "the middle, with more rays")
    detail.set(xlim=(-0.4, 0.4), ylim=(-0.4, 0.4))
    for axes, count in ((disk, drawing.FEW_RAYS), (detail, 8 * drawing.FEW_RAYS)):
        drawing.draw_bounded_rays(axes, slice_rays(cut, count), 1.2)
        drawing.draw_outline(axes, cut)
    legend_below(figure)
    return figure
