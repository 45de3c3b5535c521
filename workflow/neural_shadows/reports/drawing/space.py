"""Figures in 3D: VTK's window, camera and page."""

import os
from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from neural_shadows.errors import InputError
from neural_shadows.reports.drawing import opengl, style
from neural_shadows.reports.drawing.hero_view import hero_view
from neural_shadows.reports.drawing.style import Figure
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


def object_plotter(
    scene: "Scene", distance: float, *, opacity: float = 1.0, ground: bool = False
) -> "tuple[pyvista.Plotter, pyvista.PolyData]":
    """A window with a scene's object, smooth, and a disk of its ground.

    Args:
        distance: of the camera, in sphere radii. ground: drawn if the scene has one.
    """
    import pyvista

    plotter = new_plotter(hero_view(scene.up, distance))
    (mesh,) = scene.objects
    shape = pyvista.PolyData.from_regular_faces(mesh.vertices, mesh.faces)
    shape.point_data.active_normals = mesh.vertex_normals
    plotter.add_mesh(shape, color=OBJECT_COLOUR, smooth_shading=True, opacity=opacity)
    if ground and scene.ground is not None:
        centre = scene.ground * scene.up
        disk = pyvista.Disc(center=centre, inner=0, outer=REACH, normal=scene.up, c_res=90)
        plotter.add_mesh(disk, color="#f1eee6", lighting=False)
    return plotter, shape


def pictures(
    shown: Mapping[str, "pyvista.Plotter"],
    *,
    title: str,
    colours: Mapping[str, str] | None = None,
    scale: "tuple[str, ScalarMappable] | None" = None,
) -> Figure:
    """Draw windows with headings beside each other, with one legend.

    Args:
        colours: of the legend, by label.
        scale: label and colours of a scale at the right.
    """
    from matplotlib.patches import Patch

    images = [plotter.screenshot(return_img=True) for plotter in shown.values()]
    rows = np.flatnonzero(np.min(images, axis=(0, 2, 3)) < WHITE)
    width = min(6.2, 13.5 / len(shown))  # with three, names on a page of 1168 px are 13 px high
    height = width * (np.ptp(rows) + 1) / WIDTH
    figure = style.new_figure(title, width * len(shown), height + 1.2)
    panels = figure.subplots(1, len(shown), squeeze=False)[0]
    for axes, heading, plotter, picture in zip(panels, shown, shown.values(), images):
        axes.imshow(picture[rows[0] : rows[-1] + 1])
        plotter.close()
        axes.set_title(heading, fontsize=11)
        axes.set_axis_off()
    if scale:
        figure.colorbar(scale[1], ax=panels, label=scale[0], shrink=0.7)
    if colours:
        style.legend_below(figure, [Patch(color=c, label=label) for label, c in colours.items()])
    return figure
