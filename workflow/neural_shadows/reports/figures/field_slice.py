"""A slice of an occupancy field, beside the mesh [5.4.1]."""

from pathlib import Path
from typing import TYPE_CHECKING, Literal

import numpy as np
from pydantic import Field

from neural_shadows.reports.drawing.style import Axes, Figure, legend_below, new_figure
from neural_shadows.sections.scene_figures import FieldFigure
from neural_shadows.settings.records import SceneSettings

if TYPE_CHECKING:
    from matplotlib.image import AxesImage

    from neural_shadows.networks.object_space.occupancy_field_network import OccupancyFieldNetwork
    from neural_shadows.reports.drawing.mesh_slice import MeshSlice

PIXELS = 900  # of the slice's side
DETAIL = 0.07  # half the side of the detail, in sphere radii
EMPTY_COLOUR, ENCLOSED_COLOUR = "#f4f4f4", "#5b6b7b"


class Settings(FieldFigure):
    """A slice of an occupancy field, beside the mesh."""

    kind: Literal["field_slice"] = Field(description="`field_slice`")


def draw(mesh_ply: Path, weights: Path, title: str, scene: SceneSettings) -> Figure:
    """Draw the whole slice, and a detail of it.

    Args:
        weights: of an occupancy field.
    """
    from matplotlib.patches import Patch, Rectangle

    from neural_shadows.networks.weight_file import load_network
    from neural_shadows.reports.drawing.mesh_slice import slice_mesh
    from neural_shadows.representations.distance_bricks.field_marching import BRICK
    from neural_shadows.scenes.scene import open_scene

    cut = slice_mesh(open_scene(mesh_ply, **scene))
    field, _ = load_network(weights)
    figure = new_figure(title, 13, 6.6)
    overview, detail = figure.subplots(1, 2)
    _show(overview, field, cut, np.zeros(2), 1.0)
    overview.set_title(f"bricks of {BRICK}³ cells at the surface, {field.resolution}³ cells in all")
    centre = choose_detail(slice_logits(field, cut, np.zeros(2), 1.0))
    overview.add_patch(Rectangle(centre - DETAIL, 2 * DETAIL, 2 * DETAIL, fill=False))
    image = _show(detail, field, cut, centre, DETAIL)
    detail.set_title("the square: shadow begins where the logit turns positive")
    figure.colorbar(image, ax=detail, label="logit: outside < 0 < inside", shrink=0.8)
    empty = Patch(facecolor=EMPTY_COLOUR, edgecolor="#cccccc", label="empty: nothing stored")
    enclosed = Patch(color=ENCLOSED_COLOUR, label="enclosed: in shadow, nothing stored")
    legend_below(figure, [empty, enclosed])
    return figure


def choose_detail(logits: np.ndarray) -> np.ndarray:
    """The centre (2,) of the detail with most stored logits.

    Inside and outside count alike.

    Args:
        logits: (PIXELS, PIXELS) of the whole slice, see `slice_logits`.
    """
    from scipy.ndimage import uniform_filter

    from neural_shadows.networks.object_space.occupancy_field_network import LIMIT

    size = round(DETAIL * PIXELS)
    inside = uniform_filter(((logits > 0) & (logits <= LIMIT)).astype(float), size)
    outside = uniform_filter((logits <= 0).astype(float), size)
    row, column = np.unravel_index(np.argmax(inside * outside), logits.shape)
    return (np.array([column, row]) + 0.5) / PIXELS * 2 - 1


def slice_logits(
    field: "OccupancyFieldNetwork", cut: "MeshSlice", centre: np.ndarray, half: float
) -> np.ndarray:
    """Logits (PIXELS, PIXELS) of a square, rows upwards.

    NaN in empty bricks, beyond LIMIT in enclosed ones.

    Args:
        centre: (2,) of the square in the slice's plane; `half`: half its side.
    """
    import torch

    from neural_shadows.networks.object_space.occupancy_field_network import LIMIT
    from neural_shadows.representations.distance_bricks.field_marching import SOLID

    offsets = (np.arange(PIXELS) + 0.5) / PIXELS * 2 * half - half
    x, y = np.meshgrid(centre[0] + offsets, centre[1] + offsets)
    p = cut.to_space(np.stack([x.ravel(), y.ravel()], axis=1))
    p = torch.from_numpy(p.astype(np.float32))
    with torch.inference_mode():
        bricks = field.bricks_at(p)
        logits = torch.where(bricks == SOLID, 2 * LIMIT, torch.nan)
        stored = bricks >= 0
        logits[stored] = field.logits_at(p[stored], bricks[stored], field.logits())
    return logits.view(PIXELS, PIXELS).numpy()


def _show(
    axes: Axes, field: "OccupancyFieldNetwork", cut: "MeshSlice", centre: np.ndarray, half: float
) -> "AxesImage":
    from matplotlib import colormaps

    from neural_shadows.networks.object_space.occupancy_field_network import LIMIT
    from neural_shadows.reports.drawing.drawing import draw_outline

    extent = np.add.outer(centre, [-half, half]).ravel()
    colours = colormaps["RdBu"].with_extremes(bad=EMPTY_COLOUR, over=ENCLOSED_COLOUR)
    style = {"cmap": colours, "vmin": -LIMIT, "vmax": LIMIT, "interpolation": "nearest"}
    logits = slice_logits(field, cut, centre, half)
    image = axes.imshow(logits, extent=extent, origin="lower", **style)
    draw_outline(axes, cut)
    axes.set(xlim=extent[:2], ylim=extent[2:], xticks=[], yticks=[])
    return image
