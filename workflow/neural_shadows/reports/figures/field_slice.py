"""What an occupancy field has learned, in a slice, beside the mesh [5.4.1]."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import torch

from neural_shadows.meshes.prepared_mesh import read_prepared
from neural_shadows.networks.object_space.field_marching import BRICK, SOLID
from neural_shadows.networks.object_space.occupancy_field_network import (
    LIMIT,
    OccupancyFieldNetwork,
)
from neural_shadows.networks.weight_file import load_network
from neural_shadows.reports.figures.drawing import OUTLINE, draw_outline
from neural_shadows.reports.figures.mesh_slice import MeshSlice, slice_mesh
from neural_shadows.reports.figures.style import DPI, write_strip
from neural_shadows.scenes.lights import axis_vector
from neural_shadows.scenes.tracing import Tracer

if TYPE_CHECKING:
    from matplotlib.axes import Axes

PIXELS = 900  # of the slice's side
DETAIL = 0.14  # half the side of the detail, in sphere radii
EMPTY_COLOUR, ENCLOSED_COLOUR = "#f4f4f4", "#5b6b7b"


def slice_logits(
    field: OccupancyFieldNetwork, cut: MeshSlice, centre: np.ndarray, half: float
) -> tuple[np.ndarray, np.ndarray]:
    """Logits (PIXELS, PIXELS) of a square of the slice, NaN where no brick is, and `grid` there.

    Args:
        centre: (2,) of the square in the slice's plane; `half`: half its side. Rows run upwards.
    """
    at = (np.arange(PIXELS) + 0.5) / PIXELS * 2 * half - half
    x, y = np.meshgrid(centre[0] + at, centre[1] + at)
    p = cut.to_space(np.stack([x.ravel(), y.ravel()], axis=1))
    p = torch.from_numpy(p.astype(np.float32))
    with torch.inference_mode():
        bricks = field.bricks_at(p)
        logits = torch.full((len(p),), torch.nan)
        held = bricks >= 0
        logits[held] = field.logits_at(p[held], bricks[held], field.logits())
    return logits.view(PIXELS, PIXELS).numpy(), bricks.view(PIXELS, PIXELS).numpy()


def _show(
    axes: Axes, field: OccupancyFieldNetwork, cut: MeshSlice, centre: np.ndarray, half: float
):
    from matplotlib.colors import ListedColormap

    logits, bricks = slice_logits(field, cut, centre, half)
    extent = np.add.outer(centre, [-half, half]).ravel()
    style = {"extent": extent, "origin": "lower", "interpolation": "nearest"}
    axes.imshow(
        np.where(bricks == SOLID, 1, 0),
        cmap=ListedColormap([EMPTY_COLOUR, ENCLOSED_COLOUR]),
        vmin=0,
        vmax=1,
        **style,
    )
    image = axes.imshow(logits, cmap="RdBu", vmin=-LIMIT, vmax=LIMIT, **style)
    draw_outline(axes, cut)
    axes.set_xlim(extent[0], extent[1])
    axes.set_ylim(extent[2], extent[3])
    axes.set_xticks([])
    axes.set_yticks([])
    return image


def write_field_slice(
    mesh_ply: Path, weights: Path, png: Path, svg: Path, *, title: str, up: str
) -> None:
    """Draw the slice whole and in detail, at the outline's highest point.

    Args:
        weights: of an occupancy field.

    Raises:
        InputError: an input file is not whole.
    """
    from matplotlib.figure import Figure
    from matplotlib.patches import Patch, Rectangle

    mesh = read_prepared(mesh_ply)
    cut = slice_mesh(mesh, Tracer(mesh.vertices, mesh.faces), axis_vector(up, "up"))
    field, _ = load_network(weights)
    ends = cut.outline.reshape(-1, 2)
    top = ends[ends[:, 1].argmax()]
    figure = Figure(figsize=(13, 6.6), dpi=DPI, layout="constrained")
    whole, detail = figure.subplots(1, 2)
    _show(whole, field, cut, np.zeros(2), 1.0)
    whole.add_patch(
        Rectangle(top - DETAIL, 2 * DETAIL, 2 * DETAIL, fill=False, edgecolor=OUTLINE, linewidth=1)
    )
    whole.set_title(
        f"bricks of {BRICK}³ cells at the surface, {field.resolution}³ cells in all", fontsize=11
    )
    image = _show(detail, field, cut, top, DETAIL)
    detail.set_title("the square: shadow begins where the logit turns positive", fontsize=11)
    figure.colorbar(image, ax=detail, label="logit: outside < 0 < inside", shrink=0.8)
    figure.legend(
        handles=[
            Patch(color=OUTLINE, label="the mesh's section"),
            Patch(facecolor=EMPTY_COLOUR, edgecolor="#cccccc", label="empty: nothing stored"),
            Patch(color=ENCLOSED_COLOUR, label="enclosed: in shadow, nothing stored"),
        ],
        loc="outside lower center",
        ncols=3,
    )
    figure.suptitle(title, x=0.01, ha="left", weight="bold")
    write_strip(figure, png, svg)
