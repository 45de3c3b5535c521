"""What the figures in three dimensions share: VTK's window, the camera, the page around it."""

import os
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pyvista
from matplotlib.artist import Artist
from matplotlib.cm import ScalarMappable

from neural_shadows.errors import InputError
from neural_shadows.meshes.prepared_mesh import PreparedMesh
from neural_shadows.reports.figures import opengl
from neural_shadows.reports.figures.style import new_figure, write_figure
from neural_shadows.scenes.cameras import Viewpoint
from neural_shadows.scenes.lights import light_basis

WIDTH, HEIGHT = 900, 800  # pixels of a picture
OBJECT_COLOUR = "#d8d4cc"
GROUND_COLOUR = "#f1eee6"
FOV = 36.0
DISTANCE = 3.6  # radii: the unit sphere then fills nine tenths of the frame


def hero_view(up: np.ndarray, distance: float = DISTANCE) -> Viewpoint:
    """A three-quarter view from above, lit over the camera's left shoulder."""
    # From 20 degrees above the horizon and 30 off a coordinate axis, which shows most objects
    # from neither front nor side.
    side, across, _ = light_basis(up)
    heading = np.cos(np.radians(30)) * side + np.sin(np.radians(30)) * across
    eye = distance * (np.cos(np.radians(20)) * heading + np.sin(np.radians(20)) * up)
    # Most of what is seen is lit, and the shadow is seen too.
    light = heading + 0.9 * np.cross(heading, up) + 1.1 * up
    return Viewpoint("hero", 0, eye, np.zeros(3), up, FOV, light / np.linalg.norm(light))


def new_plotter(view: Viewpoint) -> pyvista.Plotter:
    """An empty window, off screen, seen and lit as a viewpoint says.

    Raises:
        InputError: there is no OpenGL, without which VTK would crash.
    """
    window = opengl.window_class()
    if window is None:
        raise InputError(opengl.MISSING)
    os.environ["VTK_DEFAULT_OPENGL_WINDOW"] = window
    plotter = pyvista.Plotter(off_screen=True, window_size=(WIDTH, HEIGHT), lighting="none")
    plotter.set_background("white")
    plotter.enable_anti_aliasing("ssaa")
    plotter.camera_position = (view.eye, view.target, view.up)
    plotter.camera.view_angle = view.fov
    plotter.add_light(pyvista.Light(position=4 * view.light, intensity=0.8))
    plotter.add_light(pyvista.Light(light_type="headlight", intensity=0.35))
    plotter.add_axes(line_width=3, viewport=(0, 0, 0.16, 0.18))
    return plotter


def surface(mesh: PreparedMesh) -> pyvista.PolyData:
    """A prepared mesh as VTK has it, with its smooth normals."""
    shape = pyvista.PolyData.from_regular_faces(mesh.vertices, mesh.faces)
    shape.point_data.active_normals = mesh.vertex_normals
    return shape


def lines(starts: np.ndarray, ends: np.ndarray) -> pyvista.PolyData:
    """Lines from points (n, 3) to points (n, 3)."""
    points = np.stack([starts, ends], axis=1).reshape(-1, 3).astype(np.float32)
    return pyvista.line_segments_from_points(points)


def add_sphere(plotter: pyvista.Plotter) -> None:
    """Add the bounding sphere as a net."""
    sphere = pyvista.Sphere(radius=1, theta_resolution=36, phi_resolution=18)
    plotter.add_mesh(sphere, style="wireframe", color="#d55e00", opacity=0.2, lighting=False)


def write_pictures(
    shown: Mapping[str, pyvista.Plotter],
    png: Path,
    svg: Path,
    *,
    title: str,
    entries: Sequence[Artist] = (),
    scale: tuple[str, ScalarMappable] | None = None,
) -> None:
    """Write windows beside each other, each under its heading, with one legend.

    Args:
        scale: label and colours of a scale at the right.
    """
    figure = new_figure(title, 6.2 * len(shown) + (0.9 if scale else 0), 6.4)
    panels = figure.subplots(1, len(shown), squeeze=False)[0]
    for axes, (heading, plotter) in zip(panels, shown.items()):
        axes.imshow(plotter.screenshot(return_img=True))
        plotter.close()
        axes.set_title(heading, fontsize=11)
        axes.set_axis_off()
    if scale:
        figure.colorbar(scale[1], ax=panels, label=scale[0], shrink=0.7)
    if entries:
        figure.legend(handles=entries, loc="outside lower center", ncols=4)
    write_figure(figure, png, svg)
