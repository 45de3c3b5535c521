"""A scene, its light and its training rays, in 3D."""

from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Literal

import numpy as np
from pydantic import Field

from neural_shadows.evaluation.look import BLUE, COLOURS, ORANGE
from neural_shadows.files.whole_files import read_json
from neural_shadows.layout.layout import Layout
from neural_shadows.reports.drawing import space
from neural_shadows.reports.drawing.style import Figure
from neural_shadows.scenes.lights import arc_directions, lowest_elevation
from neural_shadows.sections.scene_figures import SamplingFigure
from neural_shadows.settings.records import SceneSettings

if TYPE_CHECKING:
    import pyvista

    from neural_shadows.scenes.scene import Scene

RAYS = 300
COLOURS = {
    "light directions": COLOURS[4],
    "view directions": COLOURS[2],
    "ray: lit": ORANGE,
    "ray: between its bounds": BLUE,
    "ray: in shadow": "#8d97a3",
}


class Settings(SamplingFigure):
    """A scene, its light and rays, in 3D."""

    needs_opengl: ClassVar[bool] = True

    kind: Literal["scene_3d"] = Field(description="`scene_3d`")


def files(layout: Layout, figure: str) -> dict[str, Any]:
    settings = layout.entry("figures", figure)
    names = settings["scene"], settings["sampling"]
    return {"directions_npy": layout.paths.rays("directions.npy", *names)} | layout.shards(*names)


def draw(
    mesh_ply: Path,
    mesh_json: Path,
    directions_npy: Path,
    origins: list[Path],
    bounds: list[Path],
    title: str,
    scene: SceneSettings,
) -> Figure:
    """Draw a scene's light, view directions and training rays."""
    import pyvista

    from neural_shadows.rays.labels import chord_lengths
    from neural_shadows.rays.ray_set import RaySet
    from neural_shadows.scenes.scene import open_scene

    rays = RaySet(directions_npy, sorted(origins), sorted(bounds))
    opened = open_scene(mesh_ply, **scene)
    left, _ = space.object_plotter(opened, 4.1, ground=True)
    right, _ = space.object_plotter(opened, 4.1, opacity=0.35)  # rays go on inside the object
    sphere = pyvista.Sphere(radius=1, theta_resolution=36, phi_resolution=18)
    for plotter in (left, right):
        plotter.add_mesh(sphere, style="wireframe", color=ORANGE, opacity=0.2, lighting=False)
    light, away, lit, between, shade = COLOURS.values()
    left.add_mesh(light_domain(opened), color=light, opacity=0.2, lighting=False)
    towards = -rays.directions.astype(np.float32)
    left.add_points(towards, color=away, point_size=9, lighting=False)
    o, d, t_lb, t_ub = rays.gather(np.linspace(0, rays.count - 1, RAYS).astype(np.int64))
    chord = chord_lengths(o, d)
    end, hit = np.minimum(t_ub, chord), t_lb < chord - 1e-6
    parts = (
        (~hit, 0 * chord, chord, {"color": lit, "line_width": 1, "opacity": 0.2}),
        (hit, 0 * chord, t_lb, {"color": lit, "line_width": 2}),
        (hit, t_lb, end, {"color": between, "line_width": 6}),
        (hit, end, chord, {"color": shade, "line_width": 2}),
    )
    for mask, begin, stop, look in parts:
        if mask.any():
            ends = np.stack([o + begin[:, None] * d, o + stop[:, None] * d], axis=1)[mask]
            segments = pyvista.line_segments_from_points(ends.reshape(-1, 3))
            right.add_mesh(segments, lighting=False, **look)
    shown = {
        f"{len(towards):,} view directions; up: {scene['up']}": left,
        f"{RAYS} of {rays.count:,} training rays": right,
    }
    name = read_json(mesh_json)["name"]
    return space.pictures(shown, title=f"{title} ({name})", colours=COLOURS)


def light_domain(scene: "Scene") -> "pyvista.DataSet":
    """The light's domain, a little outside the unit sphere."""
    import pyvista

    (domain,) = scene.lights
    lowest = lowest_elevation(domain)
    if domain["domain"] == "single_axis":
        angle = np.linspace(-1, 1, 90) * (np.pi / 2 - lowest)
        arc = 1.01 * arc_directions(domain, scene.up, angle)
        return pyvista.lines_from_points(arc).tube(radius=0.02)
    # Elevations from the lowest on; a sphere's angles are counted from its direction.
    angles = {"end_phi": 90 - np.degrees(lowest), "theta_resolution": 90, "phi_resolution": 40}
    return pyvista.Sphere(radius=1.01, direction=scene.up, **angles)
