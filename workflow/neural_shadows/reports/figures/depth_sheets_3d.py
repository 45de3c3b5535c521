"""A network's depths for one light between their bounds, in three dimensions (figure 3.2)."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pyvista
import torch
from matplotlib.patches import Patch

from neural_shadows.networks.object_space.shadow_network import ShadowNetwork
from neural_shadows.networks.weight_file import load_network
from neural_shadows.rays.labels import chord_lengths, dual_bounds
from neural_shadows.rays.silhouette import entry_points
from neural_shadows.reports.figures.space import (
    FALSE_SHADOW,
    LIGHT_LEAK,
    OBJECT_COLOUR,
    hero_view,
    new_plotter,
    write_pictures,
)
from neural_shadows.reports.figures.style import BLUE, ORANGE
from neural_shadows.running.stage import run_stage
from neural_shadows.scenes.scene import Scene, open_scene

RAYS = 400  # along a side of the disk


def draw(
    mesh_ply: Path, weights: Path, png: Path, svg: Path, *, title: str, scene: Mapping[str, Any]
) -> None:
    """Draw t_pred as a sheet, below t_lb and above t_ub where it is right, whole and cut open.

    Depth runs downwards from the sphere, as the light does; the disk is across it.

    Raises:
        InputError: an input file is missing or not whole, or there is no OpenGL.
    """
    opened = open_scene(mesh_ply, **scene)
    network, _ = load_network(weights)
    whole = depth_sheets(opened, network)
    view = hero_view(np.array([0.0, 0.0, 1.0]))
    left, right = new_plotter(view), new_plotter(view)
    write_pictures(
        {"t$_{pred}$ of the rays of one light, from above": left, "cut open": right},
        png,
        svg,
        title=title,
        entries=[
            Patch(color=ORANGE, alpha=0.5, label="t$_{lb}$, the first hit"),
            Patch(color=BLUE, alpha=0.5, label="t$_{ub}$, the second hit"),
            Patch(color=OBJECT_COLOUR, label="t$_{pred}$ between them: right"),
            Patch(color=FALSE_SHADOW, label="before t$_{lb}$: false shadow"),
            Patch(color=LIGHT_LEAK, label="behind t$_{ub}$: light leak"),
        ],
    )


if "snakemake" in globals():
    run_stage(snakemake, draw)
