"""A picture of a prepared scene: object and bounding sphere, and a silhouette's quadtree."""

from pathlib import Path

import numpy as np

from neural_shadows.files.whole_files import whole_file
from neural_shadows.meshes.mesh_report import read_mesh_report
from neural_shadows.meshes.prepared_mesh import read_prepared
from neural_shadows.rays.quadtree import build_quadtree
from neural_shadows.rays.silhouette import plane_basis, silhouette
from neural_shadows.rendering.gbuffer import ground_height, primary_hits
from neural_shadows.rendering.shading import reference_visibility, shade
from neural_shadows.scenes.cameras import Viewpoint, camera_axes
from neural_shadows.scenes.lights import axis_vector, light_basis
from neural_shadows.scenes.tracing import Tracer

PIXELS = 700  # of the picture of the object, square
RESOLUTION = 128  # of the silhouette, as in the default config
SPHERE_COLOUR = "#e4572e"
QUAD_COLOUR = "#2a7de1"


def preview_scene(
    mesh_ply: Path,
    mesh_json: Path,
    picture: Path,
    *,
    up: str,
    ground: bool,
) -> None:
    """Draw the object in its bounding sphere, and a silhouette of it with its quadtree."""
    from matplotlib.collections import PatchCollection
    from matplotlib.figure import Figure
    from matplotlib.patches import Circle, Rectangle
    from matplotlib.transforms import Affine2D

    mesh, report = read_prepared(mesh_ply), read_mesh_report(mesh_json)
    tracer = Tracer(mesh.vertices, mesh.faces)
    up_vector = axis_vector(up, "up")
    # From 20 degrees above the horizon and 30 off a coordinate axis, which shows most objects
    # from neither front nor side; from 3.6 radii the sphere fills nine tenths of the frame.
    side, across, _ = light_basis(up_vector)
    heading = np.cos(np.radians(30)) * side + np.sin(np.radians(30)) * across
    eye = 3.6 * (np.cos(np.radians(20)) * heading + np.sin(np.radians(20)) * up_vector)
    # Light over the camera's left shoulder: most of what is seen is lit, and the shadow too.
    light = heading + 0.9 * np.cross(heading, up_vector) + 1.1 * up_vector
    light /= np.linalg.norm(light)
    view = Viewpoint("preview", 0, eye, np.zeros(3), up_vector, 36.0, light)
    height = ground_height(mesh, up_vector) if ground else None
    points = primary_hits(mesh, tracer, view, PIXELS, PIXELS, height)
    image = shade(points, reference_visibility(tracer, points))

    figure = Figure(figsize=(12, 6.4), dpi=110, layout="constrained")
    left, right = figure.subplots(1, 2)
    left.imshow(image, cmap="gray", vmin=0, vmax=1)
    for axis in np.eye(3):
        columns, rows = _great_circle(axis, view)
        left.plot(columns, rows, color=SPHERE_COLOUR, linewidth=0.8, alpha=0.8)
    left.set_xlim(0, PIXELS)
    left.set_ylim(PIXELS, 0)
    left.set_title(
        f"{report['name']}: {report['faces']:,} triangles, "
        f"{'watertight' if report['watertight'] else 'open'}; bounding sphere"
    )

    direction = -eye / np.linalg.norm(eye)
    covered = silhouette(tracer, direction, RESOLUTION)
    quads = build_quadtree(covered, 1)
    # Row 0 is the lowest b. The plane's basis has any turn: turned here to have `up` upwards.
    u, v = plane_basis(direction)
    upright = Affine2D().rotate(np.arctan2(u @ up_vector, v @ up_vector)) + right.transData
    right.imshow(
        np.where(covered, 0.55, 1.0),
        cmap="gray",
        vmin=0,
        vmax=1,
        origin="lower",
        extent=(-1, 1, -1, 1),
        transform=upright,
    )
    texel = 2 / RESOLUTION
    squares = [
        Rectangle((column * texel - 1, row * texel - 1), size * texel, size * texel)
        for row, column, size in quads
    ]
    right.add_collection(
        PatchCollection(
            squares, facecolor="none", edgecolor=QUAD_COLOUR, linewidth=0.4, transform=upright
        )
    )
    right.add_patch(Circle((0, 0), 1, fill=False, color=SPHERE_COLOUR))
    right.set_title(f"silhouette of {RESOLUTION}² texels, quadtree of {len(quads):,} quads")
    right.set_xlim(1.02, -1.02)  # seen along d: u × v = d points away
    right.set_ylim(-1.02, 1.02)
    for axes in (left, right):
        axes.set_xticks([])
        axes.set_yticks([])
    with whole_file(picture) as part:
        figure.savefig(part)


def _great_circle(axis: np.ndarray, view: Viewpoint) -> tuple[np.ndarray, np.ndarray]:
    """The unit sphere's great circle across `axis`, in pixel columns and rows of the picture."""
    u, v, _ = light_basis(axis)
    angle = np.linspace(0, 2 * np.pi, 200)[:, None]
    circle = np.cos(angle) * u + np.sin(angle) * v
    right, upward, depth = camera_axes(view.eye, view.target, view.up) @ (circle - view.eye).T
    scale = PIXELS / 2 / np.tan(np.radians(view.fov) / 2)
    return PIXELS / 2 + scale * right / depth, PIXELS / 2 - scale * upward / depth
