"""What an occupancy field has learned, in a slice, beside the mesh [5.4.1]."""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from pydantic import Field

from neural_shadows.layout.layout import Layout
from neural_shadows.reports.drawing.style import legend_below, new_figure, write_figure
from neural_shadows.running.stage import run_stage
from neural_shadows.sections.scene_figures import FieldFigure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.image import AxesImage

    from neural_shadows.networks.object_space.occupancy_field_network import OccupancyFieldNetwork
    from neural_shadows.reports.drawing.mesh_slice import MeshSlice

PIXELS = 900  # of the slice's side
DETAIL = 0.07  # half the side of the detail, in sphere radii
EMPTY_COLOUR, ENCLOSED_COLOUR = "#f4f4f4", "#5b6b7b"


class Settings(FieldFigure):
    """A slice of an occupancy field, beside the mesh."""

    kind: Literal["field_slice"] = Field(description="`field_slice`")


def files(layout: Layout, figure: str) -> dict[str, Any]:
    experiment = layout.entry("figures", figure)["experiment"]
    scene = layout.entry("experiments", experiment)["scene"]
    return {
        "mesh_ply": layout.paths.scene("mesh.ply", scene),
        "weights": layout.paths.network("weights.safetensors", experiment),
    }


def params(layout: Layout, figure: str) -> dict[str, Any]:
    experiment = layout.entry("figures", figure)["experiment"]
    scene = layout.entry("experiments", experiment)["scene"]
    return {"scene": layout.entry("scenes", scene)["scene"]}


def encodings(layout: Layout, figure: str) -> set[str]:
    return layout.encodings([layout.entry("figures", figure)["experiment"]])


def draw(
    mesh_ply: Path, weights: Path, png: Path, svg: Path, *, title: str, scene: Mapping[str, Any]
) -> None:
    """Draw the slice whole, and in detail where most of it is stored.

    Args:
        weights: of an occupancy field.

    Raises:
        InputError: an input file is not whole.
    """
    from matplotlib.patches import Patch, Rectangle

    from neural_shadows.networks.weight_file import load_network
    from neural_shadows.reports.drawing.mesh_slice import slice_mesh
    from neural_shadows.representations.distance_bricks.field_marching import BRICK
    from neural_shadows.scenes.scene import open_scene

    cut = slice_mesh(open_scene(mesh_ply, **scene))
    field, _ = load_network(weights)
    figure = new_figure(title, 13, 6.6)
    whole, detail = figure.subplots(1, 2)
    _show(whole, field, cut, np.zeros(2), 1.0)
    whole.set_title(f"bricks of {BRICK}³ cells at the surface, {field.resolution}³ cells in all")
    centre = choose_detail(slice_logits(field, cut, np.zeros(2), 1.0))
    whole.add_patch(Rectangle(centre - DETAIL, 2 * DETAIL, 2 * DETAIL, fill=False))
    image = _show(detail, field, cut, centre, DETAIL)
    detail.set_title("the square: shadow begins where the logit turns positive")
    figure.colorbar(image, ax=detail, label="logit: outside < 0 < inside", shrink=0.8)
    empty = Patch(facecolor=EMPTY_COLOUR, edgecolor="#cccccc", label="empty: nothing stored")
    enclosed = Patch(color=ENCLOSED_COLOUR, label="enclosed: in shadow, nothing stored")
    legend_below(figure, [empty, enclosed])
    write_figure(figure, png, svg)


def choose_detail(logits: np.ndarray) -> np.ndarray:
    """The centre (2,) of the detail that shows most of what is stored, inside and outside alike.

    `logits` (PIXELS, PIXELS) are of the whole slice, as `slice_logits` gives them.
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
    """Logits (PIXELS, PIXELS) of a square of the slice, rows upwards.

    NaN in empty bricks, beyond LIMIT in enclosed ones.

    Args:
        centre: (2,) of the square in the slice's plane; `half`: half its side.
    """
    import torch

    from neural_shadows.networks.object_space.occupancy_field_network import LIMIT
    from neural_shadows.representations.distance_bricks.field_marching import SOLID

    at = (np.arange(PIXELS) + 0.5) / PIXELS * 2 * half - half
    x, y = np.meshgrid(centre[0] + at, centre[1] + at)
    p = cut.to_space(np.stack([x.ravel(), y.ravel()], axis=1))
    p = torch.from_numpy(p.astype(np.float32))
    with torch.inference_mode():
        bricks = field.bricks_at(p)
        logits = torch.where(bricks == SOLID, 2 * LIMIT, torch.nan)
        held = bricks >= 0
        logits[held] = field.logits_at(p[held], bricks[held], field.logits())
    return logits.view(PIXELS, PIXELS).numpy()


def _show(
    axes: "Axes", field: "OccupancyFieldNetwork", cut: "MeshSlice", centre: np.ndarray, half: float
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


if "snakemake" in globals():
    run_stage(snakemake, draw)
