"""A network's depths and their bounds, in 3D [figure 3.2]."""

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar, Literal

import numpy as np
from pydantic import Field

from neural_shadows.evaluation.look import FALSE_SHADOW, LIGHT_LEAK
from neural_shadows.reports.drawing import space
from neural_shadows.reports.drawing.hero_view import hero_view
from neural_shadows.reports.drawing.style import Figure
from neural_shadows.sections.any_report import AnyFigure
from neural_shadows.sections.experiments import RayExperimentName
from neural_shadows.settings.records import SceneSettings

if TYPE_CHECKING:
    import pyvista

RAYS = 500  # along a side of the square across the light
TOLERANCE = 0.005  # of a correct depth: two thirds of a cell of a 256³ field
STEP = 0.15  # in depth between neighbouring rays: larger ones tear a sheet
COLOURS = {
    "between the bounds": space.OBJECT_COLOUR,
    "false shadow": FALSE_SHADOW,
    "light leak": LIGHT_LEAK,
}


class Settings(AnyFigure):
    """A network's depths for one light, in 3D."""

    needs_opengl: ClassVar[bool] = True

    kind: Literal["depth_sheets_3d"] = Field(description="`depth_sheets_3d`")
    experiment: RayExperimentName = Field(description="an experiment on rays")


def draw(mesh_ply: Path, weights: Path, title: str, scene: SceneSettings) -> Figure:
    """Draw t_lb, t_pred and t_ub of hitting rays as sheets."""
    import torch

    from neural_shadows.networks.weight_file import load_network
    from neural_shadows.rays.labels import chord_lengths, dual_bounds
    from neural_shadows.rays.silhouette import entry_points
    from neural_shadows.scenes.scene import open_scene

    opened = open_scene(mesh_ply, **scene)
    network, _ = load_network(weights)
    view = hero_view(opened.up, 1)
    eye = view.eye + 0.9 * view.light  # from nearer the light, where the sheets are less torn
    view = replace(view, eye=3 * eye / np.linalg.norm(eye))
    d = (-view.light).astype(np.float32)
    offsets = (np.arange(RAYS) + 0.5) / RAYS * 2 - 1
    square = np.stack(np.meshgrid(offsets, offsets), axis=-1).reshape(-1, 2)
    o = entry_points(-view.light, square)  # offsets beyond the sphere are clamped to its rim
    t_lb, t_ub = dual_bounds(opened.tracer, o, d)
    chord = chord_lengths(o, np.broadcast_to(d, o.shape))
    hit = ((square**2).sum(axis=1) < 0.99) & (t_lb < chord - 1e-6)
    with torch.inference_mode():
        t_pred = network.depths(torch.from_numpy(o), torch.from_numpy(d), torch.float32).numpy()
    t_ub, t_pred = np.minimum(t_ub, chord), np.minimum(t_pred, chord)
    error = np.select([t_pred < t_lb - TOLERANCE, t_pred > t_ub + TOLERANCE], [1, 2])
    correct = np.mean(error[hit] == 0)
    sheets = {
        "t$_{lb}$: first hit": (t_lb, 0 * error),
        f"t$_{{pred}}$: the network's prediction, {correct:.1%} correct": (t_pred, error),
        "t$_{ub}$: second hit": (t_ub, 0 * error),
    }
    shown = {}
    for heading, (t, value) in sheets.items():
        plotter = shown[heading] = space.new_plotter(view)
        plotter.add_mesh(
            sheet_of(np.where(hit, t, np.nan), o + t[:, None] * d, value),
            cmap=[*COLOURS.values()],
            clim=(0, 2),
            interpolate_before_map=False,
            smooth_shading=True,
            ambient=0.3,  # shows the colour of facets that face away from the light
            diffuse=0.7,
            show_scalar_bar=False,
        )
    return space.pictures(shown, title=title, colours=COLOURS)


def sheet_of(depths: np.ndarray, points: np.ndarray, error: np.ndarray) -> "pyvista.PolyData":
    """Quads between the points of neighbouring rays of similar depth.

    Args:
        depths: (RAYS²,), NaN without a hit; points: (RAYS², 3).
        error: (RAYS²,), the scalar of each point.
    """
    import pyvista

    i = np.arange(RAYS**2).reshape(RAYS, RAYS)
    quads = np.stack([i[:-1, :-1], i[:-1, 1:], i[1:, 1:], i[1:, :-1]], axis=-1).reshape(-1, 4)
    quads = quads[np.ptp(depths[quads], axis=1) < STEP]
    sheet = pyvista.PolyData.from_regular_faces(points, quads)
    sheet["error"] = error
    return sheet.remove_unused_points()
