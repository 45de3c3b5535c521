"""The dead-zone loss over the predicted depth (figure 3.6)."""

from pathlib import Path
from typing import Literal

import numpy as np
from pydantic import Field

from neural_shadows.evaluation.look import BLUE, ORANGE
from neural_shadows.reports.drawing.style import GRID, Figure
from neural_shadows.sections.scene_figures import SceneFigure
from neural_shadows.settings.records import SceneSettings


class Settings(SceneFigure):
    """The dead-zone loss of two rays [figure 3.6]."""

    kind: Literal["dead_zone_loss"] = Field(description="`dead_zone_loss`")


def draw(mesh_ply: Path, mesh_json: Path, title: str, scene: SceneSettings) -> Figure:
    """Draw the loss of the thickest hit and longest miss."""
    import torch

    from neural_shadows.networks.object_space.dead_zone_loss import DeadZone
    from neural_shadows.reports.drawing.drawing import open_figure
    from neural_shadows.reports.drawing.mesh_slice import slice_rays

    cut, figure = open_figure(mesh_ply, mesh_json, scene, title, 9, 4.6)
    rays = slice_rays(cut, 401)
    axes = figure.subplots()
    t = torch.linspace(0, 2, 401)
    thickness = np.where(rays.hit & np.isfinite(rays.t_ub), rays.t_ub - rays.t_lb, 0)
    miss_lengths = np.where(rays.hit, 0, rays.chord)
    for name, measure, colour in (("hits", thickness, BLUE), ("misses", miss_lengths, ORANGE)):
        if not measure.any():
            continue
        low, high = (float(bound[np.argmax(measure)]) for bound in (rays.t_lb, rays.t_ub))
        loss = DeadZone()(t, torch.tensor(low), torch.tensor(high))
        upper = "∞" if np.isinf(high) else f"{high:.2f}"
        label = f"a ray that {name}: t$_{{lb}}$ = {low:.2f}, t$_{{ub}}$ = {upper}"
        axes.plot(t, loss, color=colour, label=label)
        axes.axvspan(low, min(high, 2), color=colour, alpha=0.12, linewidth=0)
    axes.set(xlabel="predicted depth t$_{pred}$", ylabel="loss", xlim=(0, 2))
    axes.set_title("shaded: between its bounds any depth is right and costs nothing", fontsize=11)
    axes.grid(**GRID)
    axes.legend()
    return figure
