"""A silhouette with its quadtree (figure 3.4)."""

from pathlib import Path
from typing import Literal

from pydantic import Field

from neural_shadows.reports.drawing.style import Figure, note_below
from neural_shadows.sections.scene_figures import SamplingFigure
from neural_shadows.settings.records import SamplingSettings, SceneSettings


class Settings(SamplingFigure):
    """A silhouette's quadtree, and points on its quads [figure 3.4]."""

    kind: Literal["quadtree"] = Field(description="`quadtree`")


def draw(
    mesh_ply: Path,
    mesh_json: Path,
    title: str,
    scene: SceneSettings,
    sampling: SamplingSettings,
    scene_seed: int,
) -> Figure:
    """Draw a silhouette's quadtree, and points divided over its quads."""
    from neural_shadows.reports.drawing import drawing

    cut, figure = drawing.open_figure(mesh_ply, mesh_json, scene, title)
    shown = drawing.slice_silhouette(cut, sampling)
    left, right = figure.subplots(1, 2)
    quads = f"quadtree of {len(shown.quads):,} quads"
    drawing.draw_disk(left, f"silhouette of {shown.resolution}² texels, {quads}")
    shown.draw(left)
    drawing.draw_disk(right, f"{drawing.SHOWN_POINTS:,} points, divided evenly over the quads")
    shown.draw(right, quads=False)
    shown.draw_points(right, drawing.SHOWN_POINTS, scene_seed, 3)
    note_below(
        figure,
        "Grey: the object's silhouette, seen across the slice. Blue: squares, divided along its "
        "outline.\nOrange: the bounding sphere. So most rays start near the shadow's boundary.",
    )
    return figure
