"""A picture of a prepared scene."""

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle

from neural_shadows.evaluation.look import COLOURS, ORANGE
from neural_shadows.files.whole_files import read_json
from neural_shadows.rendering.exact_shadow import exact_visibility
from neural_shadows.rendering.gbuffer import render_gbuffer
from neural_shadows.rendering.shading import shade
from neural_shadows.reports.drawing.drawing import SilhouetteDrawing, draw_disk
from neural_shadows.reports.drawing.hero_view import DISTANCE, FOV, hero_view
from neural_shadows.reports.drawing.style import new_figure, note_below, write_figure
from neural_shadows.running import progress
from neural_shadows.running.stage import run_stage
from neural_shadows.scenes.cameras import Viewpoint, camera_axes
from neural_shadows.scenes.scene import Scene, open_scene
from neural_shadows.settings.records import SceneSettings

PIXELS = 700  # of the picture of the object, square
RESOLUTION = 128  # of the silhouette, as in the default config
CORNERS = 1.3  # radii: the quadtree is rotated with the view, and wider than the sphere
AXIS_COLOURS = dict(zip("xyz", (COLOURS[1], COLOURS[2], COLOURS[0])))


def draw(
    mesh_ply: Path, mesh_json: Path, png: Path, svg: Path, *, scene: SceneSettings, advice: str
) -> None:
    """Draw an object in its bounding sphere, and its quadtree.

    Args:
        advice: what to do next.

    Raises:
        InputError: an input file is missing or not whole.
    """
    report = read_json(mesh_json)
    opened = open_scene(mesh_ply, **scene)
    view = hero_view(opened.up)
    figure = new_figure(report["name"], 12.8, 7.4)
    left, right = figure.subplots(1, 2)
    left.set(xticks=[], yticks=[], title=f"{report['faces']:,} triangles; up: {scene['up']}")
    _draw_object(left, opened, view)
    basis = camera_axes(view.eye, view.target, view.up)
    shown = SilhouetteDrawing(opened.tracer, basis, RESOLUTION, 1)
    quads = f"quadtree of {len(shown.quads):,} quads"
    draw_disk(right, f"the same view's silhouette of {RESOLUTION}² texels, {quads}")
    shown.draw(right)
    right.set(xlim=(-CORNERS, CORNERS), ylim=(-CORNERS, CORNERS))
    closed = "The mesh is watertight." if report["watertight"] else "The mesh is open."
    if report["sheet"]:
        closed += " It is a sheet, without an inside, and so are its occupancy fields."
    notes = (
        f"Up is {scene['up']}: if the object is not upright, set the scene's `up` to another axis "
        f"(of the dragon `--config up=z`).\n{closed} Orange: its bounding sphere, whose radius is "
        f"the unit of all lengths.\n{advice}"
    )
    note_below(figure, notes)
    print(notes, file=progress.TERMINAL)
    write_figure(figure, png, svg)


def _draw_object(axes: Axes, scene: Scene, view: Viewpoint) -> None:
    frame = render_gbuffer(scene, view, PIXELS, PIXELS)
    image = shade(frame, exact_visibility(scene.tracer, frame))
    axes.imshow(image, cmap="gray", vmin=0, vmax=1)
    scale = PIXELS / 2 / np.tan(np.radians(FOV) / 2)
    # Seen from outside, the sphere's outline is the cone that touches it.
    radius = scale / np.sqrt(DISTANCE**2 - 1)
    axes.add_patch(Circle((PIXELS / 2, PIXELS / 2), radius, fill=False, color=ORANGE))
    corner = np.array((70, PIXELS - 70))
    right, upward, _ = camera_axes(view.eye, view.target, view.up)
    for axis, (name, colour) in zip(np.eye(3), AXIS_COLOURS.items()):
        end = corner + 65 * np.array((axis @ right, -axis @ upward))
        text = f"{name} (up)" if axis @ view.up else name
        style = {"color": colour, "weight": "bold", "ha": "center", "va": "center"}
        axes.annotate(text, corner, end, arrowprops={"arrowstyle": "<-", "color": colour}, **style)


if "snakemake" in globals():
    run_stage(snakemake, draw)
