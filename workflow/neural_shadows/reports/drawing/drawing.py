"""Parts of the method's pictures [figures 3.1 to 3.6]."""

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure
from matplotlib.patches import Circle
from matplotlib.transforms import Affine2D

from neural_shadows.evaluation.look import BLUE, ORANGE
from neural_shadows.files.whole_files import read_json
from neural_shadows.rays.poisson_disk import PatternBank
from neural_shadows.rays.quadtree import build_quadtree
from neural_shadows.rays.sampling import sample_quads
from neural_shadows.rays.silhouette import plane_basis, silhouette
from neural_shadows.reports.drawing.mesh_slice import MeshSlice, SliceRays, slice_mesh
from neural_shadows.reports.drawing.style import new_figure
from neural_shadows.scenes.scene import open_scene
from neural_shadows.scenes.tracing import Tracer
from neural_shadows.settings.records import SamplingSettings, SceneSettings

SHADE = "#b9c2cc"
OUTLINE = "#222222"
SHOWN_DIRECTIONS = 1000  # of the pattern: few enough to be distinguished on a hemisphere
SHOWN_POINTS = 3000  # on a silhouette
FEW_RAYS = 25


def open_figure(
    mesh_ply: Path, mesh_json: Path, scene: SceneSettings, title: str, *size: float
) -> tuple[MeshSlice, Figure]:
    """A scene's slice, and an empty figure titled by mesh.

    Args:
        size: width and height, inches.

    Raises:
        InputError: a file is missing or not whole.
    """
    cut = slice_mesh(open_scene(mesh_ply, **scene))
    name = read_json(mesh_json)["name"]
    return cut, new_figure(f"{title} ({name})", *(size or (12.5, 6.6)))


def draw_disk(axes: Axes, title: str) -> None:
    """Prepare axes for the unit disk of a plane."""
    axes.add_patch(Circle((0, 0), 1, fill=False, color=ORANGE, linewidth=1.2))
    axes.set(xlim=(-1.08, 1.08), ylim=(-1.08, 1.08), aspect="equal")
    axes.set_axis_off()
    axes.set_title(title, fontsize=11)


def draw_segments(axes: Axes, starts: np.ndarray, ends: np.ndarray, **style) -> None:
    """Draw lines from points (n, 2) to points (n, 2)."""
    axes.add_collection(LineCollection(np.stack([starts, ends], axis=1), **style))


def draw_outline(axes: Axes, cut: MeshSlice) -> None:
    """Draw the mesh's section."""
    # As a picture: the fence's 25,000 segments would take 3 MB in an SVG.
    style = {"colors": OUTLINE, "linewidths": 1, "zorder": 3, "label": "the mesh's section"}
    axes.add_collection(LineCollection(cut.outline, rasterized=True, **style))


def draw_bounded_rays(axes: Axes, rays: SliceRays, width: float) -> None:
    """Draw rays in parts: lit, between their bounds, in shadow."""
    hit, t_lb, end = rays.hit, rays.t_lb, rays.end
    parts = (
        (slice(None), 0 * end, t_lb, ORANGE, 1, "lit: up to t$_{lb}$, the first hit or the sphere"),
        (hit, t_lb, end, BLUE, 3.2, "t$_{lb}$ to t$_{ub}$, the second hit"),
        (hit, end, rays.chord, SHADE, 1, "in shadow"),
    )
    for mask, begin, stop, colour, factor, label in parts:
        style = {"colors": colour, "linewidths": factor * width, "label": label}
        draw_segments(axes, rays.at(begin)[mask], rays.at(stop)[mask], **style)


class SilhouetteDrawing:
    """The silhouette along a direction, its quads and points.

    Args:
        basis: rows right and up, as drawn, and the direction: (3, 3), orthonormal.
        resolution: of the silhouette; min_quad: of the quadtree, texels.
    """

    def __init__(self, tracer: Tracer, basis: np.ndarray, resolution: int, min_quad: int):
        self.resolution = resolution
        self.covered = silhouette(tracer, basis[2], resolution)
        self.quads = build_quadtree(self.covered, min_quad)
        turn = np.eye(3)
        turn[:2, :2] = basis[:2] @ np.stack(plane_basis(basis[2]), axis=1)
        self._upright = Affine2D(turn)

    def draw(self, axes: Axes, quads: bool = True) -> None:
        """Draw the silhouette, in grey, and the quadtree."""
        image = np.where(self.covered, 0.72, 1.0)  # row 0 is the lowest
        style = {"cmap": "gray", "vmin": 0, "vmax": 1, "interpolation": "nearest"}
        transform = self._upright + axes.transData
        axes.imshow(image, extent=(-1, 1, -1, 1), origin="lower", transform=transform, **style)
        if quads:
            row, column, size = self.quads.T[:, :, None]
            x, y = column + size * [0, 0, 1, 1], row + size * [0, 1, 1, 0]
            squares = np.stack([x, y], axis=-1) * 2 / self.resolution - 1
            style = {"facecolor": "none", "edgecolor": BLUE, "linewidth": 0.4, "rasterized": True}
            axes.add_collection(PolyCollection(squares, transform=transform, **style))

    def draw_points(self, axes: Axes, count: int, seed: int, size: float) -> None:
        """Draw `count` points, divided over the quads."""
        rng, bank = np.random.default_rng(seed), PatternBank(seed)
        points = sample_quads(self.quads, self.resolution, count, rng, bank)
        style = {"s": size, "color": OUTLINE, "linewidths": 0, "rasterized": True}
        axes.scatter(*points.T, transform=self._upright + axes.transData, **style)


def slice_silhouette(cut: MeshSlice, sampling: SamplingSettings) -> SilhouetteDrawing:
    """The silhouette along a slice's normal, in a sampling's resolution.

    A sampling has `silhouette_resolution` and `min_quad` even if its sampler does not use them.
    """
    # The direction points away from a viewer with `across` at the right.
    basis = np.stack([cut.across, cut.up, np.cross(cut.up, cut.across)])
    settings = sampling["silhouette_resolution"], sampling["min_quad"]
    return SilhouetteDrawing(cut.tracer, basis, *settings)


def draw_hemisphere(axes: Axes, directions: np.ndarray, title: str) -> None:
    """Draw directions (n, 3), z > 0, by Lambert's projection."""
    x, y, z = directions[directions[:, 2] > 0].T
    scale = 1 / np.sqrt(1 + z)  # equal areas
    draw_disk(axes, title)
    axes.scatter(scale * x, scale * y, s=6, color=BLUE, linewidths=0)
