"""The dead-zone loss over the predicted depth (figure 3.7)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import torch

from neural_shadows.networks.object_space.dead_zone_loss import DeadZone
from neural_shadows.reports.figures.drawing import BLUE, ORANGE
from neural_shadows.reports.figures.mesh_slice import MeshSlice, slice_rays

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def _dead_zone_loss(figure: Figure, cut: MeshSlice) -> None:
    rays = slice_rays(cut, 401)
    axes = figure.subplots()
    t = torch.linspace(0, 2, 401)
    chosen = []
    thick = np.where(rays.hit & np.isfinite(rays.t_ub), rays.t_ub - rays.t_lb, -1)
    if thick.max() > 0:
        chosen.append(("hits", int(np.argmax(thick)), BLUE))
    if not rays.hit.all():
        chosen.append(("misses", int(np.argmax(np.where(rays.hit, -1, rays.chord))), ORANGE))
    for name, i, colour in chosen:
        low, high = float(rays.t_lb[i]), float(rays.t_ub[i])
        loss = DeadZone()(t, torch.tensor(low), torch.tensor(high))
        bounds = f"t$_{{lb}}$ = {low:.2f}, t$_{{ub}}$ = " + (
            "∞" if np.isinf(high) else f"{high:.2f}"
        )
        axes.plot(t, loss, color=colour, label=f"a ray that {name}: {bounds}")
        axes.axvspan(low, min(high, 2), color=colour, alpha=0.12, linewidth=0)
    axes.set_xlabel("predicted depth t$_{pred}$")
    axes.set_ylabel("loss")
    axes.set_xlim(0, 2)
    axes.grid(linewidth=0.4, alpha=0.4)
    axes.legend()
