"""A network's depths for one light beside their bounds, in three dimensions (figure 3.2)."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pyvista
import torch

from neural_shadows.networks.weight_file import load_network
from neural_shadows.rays.labels import chord_lengths, dual_bounds
from neural_shadows.rays.silhouette import entry_points
from neural_shadows.reports.figures import space
from neural_shadows.reports.figures.hero_view import hero_view
from neural_shadows.reports.figures.style import Section
from neural_shadows.running.stage import run_stage
from neural_shadows.scenes.scene import open_scene

RAYS = 500  # along a side of the disk across the light
TOLERANCE = 0.005  # of a depth that counts as right: two thirds of a cell of a 256³ field
STEP = 0.15  # in depth between neighbouring rays: beyond it, a sheet is torn


def draw(
    mesh_ply: Path, weights: Path, png: Path, svg: Path, *, title: str, scene: Section
) -> None:
    """Draw t_lb, t_pred and t_ub of a light's rays that hit, each as a sheet where it lies.

    Raises:
        InputError: an input file is missing or not whole, or there is no OpenGL.
    """
    opened = open_scene(mesh_ply, **scene)
    network, _ = load_network(weights)
    view = hero_view(opened.up)
    # From nearer the light, where less of the sheets is torn.
    eye = view.eye / np.linalg.norm(view.eye) + 0.9 * view.light
    view = replace(view, eye=3.0 * eye / np.linalg.norm(eye))
    d = (-view.light).astype(np.float32)
    at = (np.arange(RAYS) + 0.5) / RAYS * 2 - 1
    disk = np.stack(np.meshgrid(at, at), axis=-1).reshape(-1, 2)
    o = entry_points(-view.light, disk)  # offsets beyond the sphere are taken to its rim
    t_lb, t_ub = dual_bounds(opened.tracer, o, d)
    chord = chord_lengths(o, np.broadcast_to(d, o.shape))
    hit = ((disk**2).sum(axis=1) < 0.99) & (t_lb < chord - 1e-6)
    t_ub = np.minimum(t_ub, chord)
    with torch.inference_mode():
        depths = network.depths(torch.from_numpy(o), torch.from_numpy(d), torch.float32)
    t_pred = np.minimum(depths.numpy(), chord)
    early, late = t_pred < t_lb - TOLERANCE, t_pred > t_ub + TOLERANCE
    error = np.select([early, late], [1, 2])
    colours = [space.OBJECT_COLOUR, space.FALSE_SHADOW, space.LIGHT_LEAK]
    plotters = []
    for t in (t_lb, t_pred, t_ub):
        sheet = sheet_of(np.where(hit, t, np.nan), o + t[:, None] * d)
        sheet["error"] = (error if t is t_pred else 0 * error)[sheet["ray"]]
        plotters.append(space.new_plotter(view))
        plotters[-1].add_mesh(
            sheet,
            scalars="error",
            cmap=colours,
            clim=(0, 2),
            interpolate_before_map=False,
            smooth_shading=True,
            ambient=0.3,  # so that the colour is seen of facets turned from the light
            diffuse=0.7,
            show_scalar_bar=False,
        )
    right = 1 - np.mean((early | late)[hit])
    headings = (
        "t$_{lb}$: what the light meets",
        f"t$_{{pred}}$: what the network answers, {right:.0%} right",
        "t$_{ub}$: where it would leave",
    )
    space.write_pictures(
        dict(zip(headings, plotters)),
        png,
        svg,
        title=title,
        colours=dict(zip(("between the bounds", "false shadow", "light leak"), colours)),
    )


def sheet_of(depths: np.ndarray, points: np.ndarray) -> pyvista.PolyData:
    """Quads between the points (RAYS², 3) of rays whose depths (RAYS²,), NaN for none, are near.

    The sheet's points have the index of their `ray`.
    """
    i = np.arange(RAYS**2).reshape(RAYS, RAYS)
    quads = np.stack([i[:-1, :-1], i[:-1, 1:], i[1:, 1:], i[1:, :-1]], axis=-1).reshape(-1, 4)
    quads = quads[np.ptp(depths[quads], axis=1) < STEP]
    rays, corners = np.unique(quads, return_inverse=True)
    sheet = pyvista.PolyData.from_regular_faces(points[rays], corners.reshape(-1, 4))
    sheet["ray"] = rays
    return sheet


if "snakemake" in globals():
    run_stage(snakemake, draw)
