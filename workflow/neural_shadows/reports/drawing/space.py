"""Figures in 3D: VTK's window, camera and page."""

import os
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from neural_shadows.errors import InputError
from neural_shadows.reports.drawing import opengl, style
from neural_shadows.scenes.cameras import Viewpoint

if TYPE_CHECKING:
    import pyvista
    from matplotlib.cm import ScalarMappable

    from neural_shadows.scenes.scene import Scene

WIDTH, HEIGHT = 900, 800  # pixels of a picture
OBJECT_COLOUR = "#d8d4cc"
WHITE = 250  # of 255: rows above and below that are white in all pictures are cropped
REACH = 1.2  # radius of the drawn ground, in sphere radii


def new_plotter(view: Viewpoint) -> "pyvista.Plotter":
    """An off-screen window with a viewpoint's camera and light.

    Raises:
        InputError: there is no OpenGL, without which VTK would crash.
    """
    import pyvista

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


def add_object(
    plotter: "pyvista.Plotter", scene: "Scene", opacity: float = 1.0
) -> "pyvista.PolyData":
    """Add and return a scene's object with smooth normals."""
    import pyvista

    (mesh,) = scene.objects
    shape = pyvista.PolyData.from_regular_faces(mesh.vertices, mesh.faces)
    shape.point_data.active_normals = mesh.vertex_normals
    plotter.add_mesh(shape, color=OBJECT_COLOUR, smooth_shading=True, opacity=opacity)
    return shape


def add_ground(plotter: "pyvista.Plotter", scene: "Scene") -> None:
    """Add a disk of a scene's ground, if any."""
    import pyvista

    if scene.ground is not None:
        centre = scene.ground * scene.up
        disk = pyvista.Disc(center=centre, inner=0, outer=REACH, normal=scene.up, c_res=90)
        plotter.add_mesh(disk, color="#f1eee6", lighting=False)


def write_pictures(
    shown: Mapping[str, "pyvista.Plotter"],
    png: Path,
    svg: Path,
    *,
    title: str,
    colours: Mapping[str, str] | None = None,
    scale: "tuple[str, ScalarMappable] | None" = None,
) -> None:
    """Write windows with headings beside each other, with one legend.

    Args:
        colours: of the legend, by label.
        scale: label and colours of a scale at the right.
    """
    from matplotlib.patches import Patch

    pictures = [plotter.screenshot(return_img=True) for plotter in shown.values()]
    rows = np.flatnonzero(np.min(pictures, axis=(0, 2, 3)) < WHITE)
    width = min(6.2, 13.5 / len(shown))  # with three, names on a page of 1168 px are 13 px high
    height = width * (np.ptp(rows) + 1) / WIDTH
    figure = style.new_figure(title, width * len(shown), height + 1.2)
    panels = figure.subplots(1, len(shown), squeeze=False)[0]
    for axes, heading, plotter, picture in zip(panels, shown, shown.values(), pictures):
        axes.imshow(picture[rows[0] : rows[-1] + 1])
        plotter.close()
        axes.set_title(heading, fontsize=11)
        axes.set_axis_off()
    if scale:
        figure.colorbar(scale[1], ax=panels, label=scale[0], shrink=0.7)
    if colours:
        style.legend_below(figure, [Patch(color=c, label=label) for label, c in colours.items()])
    style.write_figure(figure, png, svg)
