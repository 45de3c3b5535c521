"""A scene in its bounding sphere, its light, and what is sampled of it, in three dimensions."""

from pathlib import Path

import numpy as np
import pyvista

from neural_shadows.meshes.mesh_report import read_mesh_report
from neural_shadows.rays.labels import chord_lengths
from neural_shadows.rays.ray_set import RaySet
from neural_shadows.reports.figures import space
from neural_shadows.reports.figures.hero_view import hero_view
from neural_shadows.reports.figures.style import BLUE, COLOURS, ORANGE, Section
from neural_shadows.running.stage import run_stage
from neural_shadows.scenes.lights import arc_directions, lowest_elevation
from neural_shadows.scenes.scene import Scene, open_scene

RAYS = 300
SHADE, LIGHT_COLOUR, DIRECTION_COLOUR = "#8d97a3", COLOURS[4], COLOURS[2]


def draw(
    mesh_ply: Path,
    mesh_json: Path,
    directions_npy: Path,
    origins: list[Path],
    bounds: list[Path],
    png: Path,
    svg: Path,
    *,
    title: str,
    scene: Section,
) -> None:
    """Draw a scene with its light and view directions, and some of its training rays.

    Raises:
        InputError: an input file is missing or not whole, or there is no OpenGL.
    """
    rays = RaySet(directions_npy, sorted(origins), sorted(bounds))
    opened = open_scene(mesh_ply, **scene)
    view = hero_view(opened.up, 3.9)
    left, right = space.new_plotter(view), space.new_plotter(view)
    sphere = pyvista.Sphere(radius=1, theta_resolution=36, phi_resolution=18)
    for plotter, opacity in ((left, 1.0), (right, 0.35)):  # rays go on inside the object
        space.add_object(plotter, opened, opacity)
        plotter.add_mesh(sphere, style="wireframe", color=ORANGE, opacity=0.2, lighting=False)
    space.add_ground(left, opened)
    left.add_mesh(light_domain(opened), color=LIGHT_COLOUR, opacity=0.2, lighting=False)
    style = {"render_points_as_spheres": True, "lighting": False}
    towards = -rays.directions.astype(np.float32)
    left.add_points(towards, color=DIRECTION_COLOUR, point_size=9, **style)
    _add_rays(right, rays)
    name = read_mesh_report(mesh_json)["name"]
    space.write_pictures(
        {
            f"{len(towards):,} view directions; up: {scene['up']}": left,
            f"{RAYS} of {rays.count:,} training rays": right,
        },
        png,
        svg,
        title=f"{title} ({name})",
        colours={
            "where the light comes from": LIGHT_COLOUR,
            "view directions": DIRECTION_COLOUR,
            "ray: lit": ORANGE,
            "ray: between its bounds": BLUE,
            "ray: in shadow": SHADE,
        },
    )


def light_domain(scene: Scene) -> pyvista.DataSet:
    """The part of the unit sphere that the scene's light comes from, a little outside it."""
    (domain,) = scene.lights
    lowest = lowest_elevation(domain)
    if domain["domain"] == "single_axis":
        angle = np.linspace(-1, 1, 90) * (np.pi / 2 - lowest)
        arc = 1.01 * arc_directions(domain, scene.up, angle)
        return pyvista.lines_from_points(arc).tube(radius=0.02)
    # With no elevation below the lowest; a sphere's angles are counted from its direction.
    angles = {"end_phi": 90 - np.degrees(lowest), "theta_resolution": 90, "phi_resolution": 40}
    return pyvista.Sphere(radius=1.01, direction=scene.up, **angles)


def _add_rays(plotter: pyvista.Plotter, rays: RaySet) -> None:
    """Add rays evenly spaced through the ray set, in the colours of their bounds."""
    index = np.linspace(0, rays.count - 1, RAYS).astype(np.int64)
    o, d, t_lb, t_ub = rays.gather(index)
    chord = chord_lengths(o, d)
    end = np.minimum(t_ub, chord)
    hit = t_lb < chord - 1e-6
    parts = (
        (~hit, 0 * chord, chord, {"color": ORANGE, "line_width": 1, "opacity": 0.2}),
        (hit, 0 * chord, t_lb, {"color": ORANGE, "line_width": 2}),
        (hit, t_lb, end, {"color": BLUE, "line_width": 6}),
        (hit, end, chord, {"color": SHADE, "line_width": 2}),
    )
    for which, begin, stop, style in parts:
        if which.any():
            ends = np.stack([o + begin[:, None] * d, o + stop[:, None] * d], axis=1)[which]
            segments = pyvista.line_segments_from_points(ends.reshape(-1, 3))
            plotter.add_mesh(segments, lighting=False, **style)


if "snakemake" in globals():
    run_stage(snakemake, draw)
