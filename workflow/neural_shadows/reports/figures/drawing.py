"""Pictures of how the method works, drawn from real data [figures 3.1 to 3.6]."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import numpy as np

from neural_shadows.rays.draw_directions import make_directions
from neural_shadows.rays.poisson_disk import PatternBank
from neural_shadows.rays.quadtree import build_quadtree
from neural_shadows.rays.sampling import sample_quads
from neural_shadows.rays.silhouette import plane_basis, silhouette
from neural_shadows.reports.figures.mesh_slice import MeshSlice, SliceRays
from neural_shadows.reports.figures.style import COLOURS

if TYPE_CHECKING:
    from matplotlib.axes import Axes

BLUE, ORANGE = COLOURS[:2]
SHADE = "#b9c2cc"
OUTLINE = "#222222"
SHOWN_DIRECTIONS = 1000  # of the pattern: a hemisphere of them can still be told apart
SHOWN_POINTS = 3000  # on a silhouette
FEW_RAYS = 25
# Segments of a slice that an SVG holds as such, at 45 bytes each: the Stanford dragon at half its
# resolution has 3,000; of the fence's 25,000 it gets a picture.
DRAWN_SEGMENTS = 4000


def _plane(axes: Axes, title: str) -> None:
    """Prepare axes for the unit disk of a plane."""
    from matplotlib.patches import Circle

    axes.add_patch(Circle((0, 0), 1, fill=False, color=ORANGE, linewidth=1.2))
    axes.set_xlim(-1.08, 1.08)
    axes.set_ylim(-1.08, 1.08)
    axes.set_aspect("equal")
    axes.set_axis_off()
    axes.set_title(title, fontsize=11)


def _segments(axes: Axes, starts: np.ndarray, ends: np.ndarray, **style) -> None:
    from matplotlib.collections import LineCollection

    axes.add_collection(LineCollection(np.stack([starts, ends], axis=1), **style))


def draw_outline(axes: Axes, cut: MeshSlice) -> None:
    """Draw the mesh's section."""
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path as Outline

    # One path: as lines of their own the segments take three times the bytes in an SVG.
    count = len(cut.outline)
    path = Outline(cut.outline.reshape(-1, 2), [Outline.MOVETO, Outline.LINETO] * count)
    axes.add_patch(
        PathPatch(
            path,
            fill=False,
            edgecolor=OUTLINE,
            linewidth=1.0,
            zorder=3,
            rasterized=count > DRAWN_SEGMENTS,
        )
    )


def _rays_with_bounds(axes: Axes, rays: SliceRays, width: float) -> None:
    """Each ray up to its lower bound, between the bounds, and in shadow from there on."""
    hit = rays.hit
    end = np.minimum(rays.t_ub, rays.chord)
    _segments(axes, rays.at(0 * end), rays.at(rays.t_lb), colors=ORANGE, linewidths=width)
    between = rays.at(rays.t_lb)[hit], rays.at(end)[hit]
    _segments(axes, *between, colors=BLUE, linewidths=3.2 * width)
    behind = rays.at(end)[hit], rays.at(rays.chord)[hit]
    _segments(axes, *behind, colors=SHADE, linewidths=width)


def _points_of(
    cut: MeshSlice, sampling: Mapping[str, Any], seed: int, count: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray, int]:
    """Silhouette along the slice's normal, its quads, `count` points, and its resolution.

    Offsets are turned so that (x, y) is (across, up), seen from the front.
    """
    resolution = sampling["silhouette_resolution"]
    direction = np.cross(cut.up, cut.across)  # away from who sees `across` to the right
    covered = silhouette(cut.tracer, direction, resolution)
    quads = build_quadtree(covered, sampling["min_quad"])
    rng = np.random.default_rng(seed)
    offsets = sample_quads(quads, resolution, count, rng, PatternBank(seed))
    return covered, quads, offsets, resolution


def _upright(cut: MeshSlice, axes: Axes):
    """The transform that shows offsets (a, b) with `across` to the right and `up` upwards."""
    from matplotlib.transforms import Affine2D

    u, v = plane_basis(np.cross(cut.up, cut.across))
    matrix = np.eye(3)
    matrix[:2, :2] = [[u @ cut.across, v @ cut.across], [u @ cut.up, v @ cut.up]]
    return Affine2D(matrix) + axes.transData


def _silhouette(axes: Axes, cut: MeshSlice, covered: np.ndarray) -> None:
    axes.imshow(
        np.where(covered, 0.72, 1.0),
        cmap="gray",
        vmin=0,
        vmax=1,
        origin="lower",
        extent=(-1, 1, -1, 1),
        interpolation="nearest",
        transform=_upright(cut, axes),
    )


def _quads(axes: Axes, cut: MeshSlice, quads: np.ndarray, resolution: int) -> None:
    from matplotlib.collections import PatchCollection
    from matplotlib.patches import Rectangle

    texel = 2 / resolution
    squares = [
        Rectangle((column * texel - 1, row * texel - 1), size * texel, size * texel)
        for row, column, size in quads
    ]
    axes.add_collection(
        PatchCollection(
            squares,
            facecolor="none",
            edgecolor=BLUE,
            linewidth=0.4,
            transform=_upright(cut, axes),
            rasterized=True,
        )
    )


def _points(axes: Axes, cut: MeshSlice, offsets: np.ndarray, size: float) -> None:
    axes.scatter(
        *offsets.T,
        s=size,
        color=OUTLINE,
        linewidths=0,
        transform=_upright(cut, axes),
        rasterized=True,
    )


def _drawn(sampler: str, seed: int) -> np.ndarray:
    """The pipeline's own view directions of a sampler, (n, 3)."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / "directions.npy"
        make_directions(path, sampler=sampler, directions=SHOWN_DIRECTIONS, seed=seed)
        return np.load(path, allow_pickle=False)


def _hemisphere(axes: Axes, directions: np.ndarray, title: str) -> None:
    """Directions of the upper hemisphere, in Lambert's equal-area projection."""
    x, y, z = directions[directions[:, 2] > 0].T
    scale = 1 / np.sqrt(1 + z)
    _plane(axes, title)
    axes.scatter(scale * x, scale * y, s=6, color=BLUE, linewidths=0)
