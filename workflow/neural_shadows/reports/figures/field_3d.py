"""The learned surface of an occupancy field, in 3D."""

from pathlib import Path
from typing import TYPE_CHECKING, ClassVar, Literal

import numpy as np
from pydantic import Field

from neural_shadows.reports.drawing import space
from neural_shadows.reports.drawing.hero_view import hero_view
from neural_shadows.reports.drawing.style import Figure
from neural_shadows.sections.scene_figures import FieldFigure
from neural_shadows.settings.records import SceneSettings

if TYPE_CHECKING:
    import pyvista

    from neural_shadows.networks.object_space.occupancy_field_network import OccupancyFieldNetwork

COLOURS = "RdBu_r"


class Settings(FieldFigure):
    """The surface of an occupancy field, in 3D."""

    needs_opengl: ClassVar[bool] = True

    kind: Literal["field_3d"] = Field(description="`field_3d`")


def draw(mesh_ply: Path, weights: Path, title: str, scene: SceneSettings) -> Figure:
    """Draw the mesh, and the learned surface coloured by distance.

    Args:
        weights: of an occupancy field.
    """
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize

    from neural_shadows.networks.weight_file import load_network
    from neural_shadows.scenes.scene import open_scene

    opened = open_scene(mesh_ply, **scene)
    left, shape = space.object_plotter(opened, 3.0)
    right = space.new_plotter(hero_view(opened.up, 3.0))
    field, _ = load_network(weights)
    learned = learned_surface(field).compute_implicit_distance(shape)
    distance = learned["implicit_distance"] * field.resolution / 2
    learned["cells"] = np.abs(distance) if field.surface == "sheet" else distance
    style = {"cmap": COLOURS, "clim": (-0.5, 0.5), "show_scalar_bar": False}
    right.add_mesh(learned, scalars="cells", smooth_shading=True, **style)
    within = np.mean(np.abs(distance) < 0.5)
    shown = {
        f"the mesh: {shape.n_cells:,} triangles": left,
        f"the field of {field.resolution}³ cells: {within:.1%} within half a cell": right,
    }
    scale = "distance from the mesh, cells: outside > 0 > inside"
    colours = ScalarMappable(Normalize(-0.5, 0.5), COLOURS)
    return space.pictures(shown, title=title, scale=(scale, colours))


def learned_surface(field: "OccupancyFieldNetwork") -> "pyvista.PolyData":
    """The zero level of the logits at the cells' vertices."""
    import pyvista

    from neural_shadows.networks.object_space.occupancy_field_network import LIMIT
    from neural_shadows.representations.distance_bricks.field_marching import BRICK, SOLID

    size = field.resolution
    bricks = field.grid.view((size // BRICK,) * 3).numpy()
    logits = np.full((size + 1,) * 3, -LIMIT, np.float32)
    solid = np.where(bricks == SOLID, LIMIT, -LIMIT)
    logits[:-1, :-1, :-1] = solid.repeat(BRICK, 0).repeat(BRICK, 1).repeat(BRICK, 2)
    corners = np.indices((BRICK + 1,) * 3).reshape(3, -1).T
    vertices = BRICK * np.argwhere(bricks >= 0)[:, None] + corners
    logits[tuple(np.moveaxis(vertices, -1, 0))] = (
        field.logits().detach()[field.table.long()].view(vertices.shape[:2])
    )
    # Nothing is learned beyond the bounding sphere, where no rays run.
    square = np.linspace(-1, 1, size + 1) ** 2
    logits[square[:, None, None] + square[:, None] + square > 1] = -LIMIT
    spacing = (2 / size,) * 3
    grid = pyvista.ImageData(dimensions=logits.shape, spacing=spacing, origin=(-1, -1, -1))
    grid["logit"] = logits.ravel(order="F")
    return grid.contour([0.0], "logit")
