"""Pictures of how the method works, drawn from real data [figures 3.1 to 3.6]."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import numpy as np
import torch

from neural_shadows.dead_zone_loss import DeadZone
from neural_shadows.direction_spectrum import angular_power_spectrum
from neural_shadows.errors import InputError
from neural_shadows.light import axis_vector
from neural_shadows.loss_figure import COLOURS
from neural_shadows.mesh import read_prepared
from neural_shadows.mesh_slice import MeshSlice, SliceRays, slice_mesh, slice_rays
from neural_shadows.poisson_disk import PatternBank
from neural_shadows.quadtree import build_quadtree
from neural_shadows.ray_sampling import sample_quads
from neural_shadows.records import read_mesh_report
from neural_shadows.silhouette import plane_basis, silhouette
from neural_shadows.strips import DPI, write_strip
from neural_shadows.tracing import Tracer
from neural_shadows.view_directions import make_directions

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

BLUE, ORANGE = COLOURS[:2]
SHADE = "#b9c2cc"
OUTLINE = "#222222"
SHOWN_DIRECTIONS = 1000  # of the pattern: a hemisphere of them can still be told apart
SHOWN_POINTS = 3000  # on a silhouette
DEGREES = 80  # of the spectra: 1000 Poisson-disk directions have their ring near degree 50
FEW_RAYS = 25
# Segments of a slice that an SVG holds as such, at 45 bytes each: the Stanford dragon at half its
# resolution has 3,000; of the fence's 25,000 it gets a picture.
DRAWN_SEGMENTS = 4000


def draw_method_figure(
    kind: str,
    mesh_ply: Path,
    mesh_json: Path,
    png: Path,
    svg: Path,
    *,
    title: str,
    up: str,
    sampling: Mapping[str, Any],
    seed: int,
) -> None:
    """Draw one of the pictures of chapter 3 and write it as PNG and SVG.

    Args:
        kind: `overview`, `shadow_boundary`, `view_directions`, `quadtree`, `dual_bounds` or
            `dead_zone_loss`.
        up: the scene's axis that points up.
        sampling: settings of a sampling; its silhouette_resolution and min_quad are shown, also
            of a sampler that does without.

    Raises:
        InputError: an unknown kind, or an input file is not whole.
    """
    from matplotlib.figure import Figure

    mesh = read_prepared(mesh_ply)
    tracer = Tracer(mesh.vertices, mesh.faces)
    cut = slice_mesh(mesh, tracer, axis_vector(up, "up"))
    wide = {"overview": (13.3, 4), "dead_zone_loss": (9, 4.6), "view_directions": (11, 9.6)}
    figure = Figure(figsize=wide.get(kind, (12.5, 6.6)), dpi=DPI, layout="constrained")
    match kind:
        case "overview":
            _overview(figure, cut, sampling, seed)
        case "shadow_boundary":
            _shadow_boundary(figure, cut)
        case "view_directions":
            _view_directions(figure, seed)
        case "quadtree":
            _quadtree(figure, cut, sampling, seed)
        case "dual_bounds":
            _dual_bounds(figure, cut)
        case "dead_zone_loss":
            _dead_zone_loss(figure, cut)
        case _:
            raise InputError(f"figure kind {kind!r} is unknown; use one of those in the config")
    name = read_mesh_report(mesh_json)["name"]
    figure.suptitle(f"{title} ({name})", x=0.01, ha="left", weight="bold")
    write_strip(figure, png, svg)


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


def _overview(figure: Figure, cut: MeshSlice, sampling: Mapping[str, Any], seed: int) -> None:
    from matplotlib.patheffects import withStroke

    directions, points, labels, query = figure.subplots(1, 4)
    _hemisphere(directions, _drawn("poisson_quadtree", seed), "a  view directions")
    covered, quads, offsets, resolution = _points_of(cut, sampling, seed, SHOWN_POINTS // 3)
    _plane(points, "b  rays through a silhouette's quadtree")
    _silhouette(points, cut, covered)
    _quads(points, cut, quads, resolution)
    _points(points, cut, offsets, 2)
    _plane(labels, "c  labels: bounds along the rays")
    _rays_with_bounds(labels, slice_rays(cut, FEW_RAYS), 1.0)
    draw_outline(labels, cut)
    _plane(query, "d  a query: p is in shadow, as s > t$_s$")
    draw_outline(query, cut)
    rays = slice_rays(cut, 401)
    # The ray whose parts before, in and behind the object are all long enough to be seen.
    end = np.minimum(rays.t_ub, rays.chord)
    shortest = np.minimum(rays.t_lb, np.minimum(end - rays.t_lb, rays.chord - end))
    i = int(np.argmax(np.where(rays.hit, shortest, -1)))
    o, d = rays.origins[i], rays.direction
    first, last = float(rays.t_lb[i]), float(min(rays.t_ub[i], rays.chord[i]))
    depth, s = (first + last) / 2, last + 0.6 * (float(rays.chord[i]) - last)
    for begin, end, colour in ((0, depth, ORANGE), (depth, s, SHADE)):
        query.plot(*np.stack([o + begin * d, o + end * d]).T, color=colour, linewidth=2)
    query.plot(*np.stack([o - 0.2 * d, o]).T, color=ORANGE, linewidth=2, linestyle=":")
    query.annotate("light", o - 0.26 * d, ha="center", va="center", color=ORANGE)
    query.set_xlim(-1.25, 1.25)
    query.set_ylim(-1.25, 1.25)
    side = 0.13 * np.array([-d[1], d[0]])
    for t, text, colour in ((0.0, "o", ORANGE), (depth, "t$_s$", BLUE), (s, "p", OUTLINE)):
        query.plot(*(o + t * d), "o", color=colour, zorder=4)
        query.annotate(
            text,
            o + t * d + side,
            ha="center",
            va="center",
            fontsize=12,
            zorder=5,
            path_effects=[withStroke(linewidth=2.5, foreground="white")],
        )


def _shadow_boundary(figure: Figure, cut: MeshSlice) -> None:
    from matplotlib.patches import Patch

    plane, graph = figure.subplots(1, 2)
    rays = slice_rays(cut, 1200)
    hit = rays.hit
    end = np.minimum(rays.t_ub, rays.chord)
    _plane(plane, "the slice, lit from the upper left")
    width = 0.5
    _segments(
        plane,
        rays.at(end)[hit],
        rays.at(rays.chord)[hit],
        colors=SHADE,
        linewidths=width,
        rasterized=True,
    )
    _segments(
        plane,
        rays.at(rays.t_lb)[hit],
        rays.at(end)[hit],
        colors=BLUE,
        linewidths=width,
        rasterized=True,
    )
    draw_outline(plane, cut)
    few = slice_rays(cut, 12)
    _segments(plane, few.at(np.zeros(12)), few.at(few.t_lb), colors=ORANGE, linewidths=1)
    graph.fill_between(rays.offset, rays.chord, np.where(hit, end, rays.chord), color=SHADE)
    graph.fill_between(
        rays.offset, rays.t_lb, np.where(hit, end, rays.t_lb), color=BLUE, linewidth=0
    )
    graph.plot(rays.offset, rays.chord, color=ORANGE, linewidth=1.2)
    graph.set_xlabel("offset of the ray across the light")
    graph.set_ylabel("depth t along the ray, from the sphere")
    graph.set_title("the same by depth: a boundary t$_s$ within the blue is right", fontsize=11)
    graph.grid(linewidth=0.4, alpha=0.4)
    figure.legend(
        handles=[
            Patch(color=BLUE, label="between first and second hit: t$_s$ may lie anywhere"),
            Patch(color=SHADE, label="in shadow"),
            Patch(color=ORANGE, label="bounding sphere and light"),
        ],
        loc="outside lower center",
        ncols=3,
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


def _view_directions(figure: Figure, seed: int) -> None:
    samplers = {"poisson_quadtree": "Poisson-disk", "uniform": "uniform"}
    grid = figure.add_gridspec(2, 2, height_ratios=(3, 2))
    spectrum = figure.add_subplot(grid[1, :])
    for column, (sampler, label) in enumerate(samplers.items()):
        directions = _drawn(sampler, seed)
        axes = figure.add_subplot(grid[0, column])
        _hemisphere(axes, directions, f"{label} (a hemisphere of {SHOWN_DIRECTIONS} directions)")
        power = angular_power_spectrum(directions, DEGREES)
        colour = (BLUE, ORANGE)[column]
        spectrum.plot(np.arange(1, DEGREES + 1), power, color=colour, marker=".", label=label)
    spectrum.axhline(1, color="grey", linestyle="--", linewidth=1, label="expected of uniform")
    spectrum.set_ylim(bottom=0)
    spectrum.set_xlabel("degree of the spherical harmonics")
    spectrum.set_ylabel("power")
    spectrum.grid(linewidth=0.4, alpha=0.4)
    spectrum.legend()


def _quadtree(figure: Figure, cut: MeshSlice, sampling: Mapping[str, Any], seed: int) -> None:
    covered, quads, offsets, resolution = _points_of(cut, sampling, seed, SHOWN_POINTS)
    left, right = figure.subplots(1, 2)
    _plane(left, f"silhouette of {resolution}² texels, quadtree of {len(quads):,} quads")
    _silhouette(left, cut, covered)
    _quads(left, cut, quads, resolution)
    _plane(right, f"{SHOWN_POINTS:,} points, divided evenly over the quads")
    _silhouette(right, cut, covered)
    _points(right, cut, offsets, 3)


def _dual_bounds(figure: Figure, cut: MeshSlice) -> None:
    from matplotlib.lines import Line2D

    whole, part = figure.subplots(1, 2)
    rays = slice_rays(cut, FEW_RAYS)
    dense = slice_rays(cut, 8 * FEW_RAYS)
    _plane(whole, f"{FEW_RAYS} of a light's rays")
    _plane(part, "the middle, with more rays")
    part.set_xlim(-0.4, 0.4)
    part.set_ylim(-0.4, 0.4)
    for axes, shown in ((whole, rays), (part, dense)):
        _rays_with_bounds(axes, shown, 1.2)
        draw_outline(axes, cut)
    figure.legend(
        handles=[
            Line2D([], [], color=ORANGE, label="lit: up to t$_{lb}$, the first hit or the sphere"),
            Line2D([], [], color=BLUE, linewidth=4, label="t$_{lb}$ to t$_{ub}$, the second hit"),
            Line2D([], [], color=SHADE, label="in shadow"),
        ],
        loc="outside lower center",
        ncols=3,
    )


def _dead_zone_loss(figure: Figure, cut: MeshSlice) -> None:
    rays = slice_rays(cut, 401)
    axes = figure.subplots()
    t = torch.linspace(0, 2, 401)
    chosen = []
    thick = np.where(rays.hit & np.isfinite(rays.t_ub), rays.t_ub - rays.t_lb, -1)
    if thick.max() > 0:
        chosen.append(("hits", int(np.argmax(thick)), BLUE))
    if not rays.hit.all():
        chosen.append(("misses", int(np.argmax(np.where(rays.hit, -1, rays.chord))), ORANGE))
    for name, i, colour in chosen:
        low, high = float(rays.t_lb[i]), float(rays.t_ub[i])
        loss = DeadZone()(t, torch.tensor(low), torch.tensor(high))
        bounds = f"t$_{{lb}}$ = {low:.2f}, t$_{{ub}}$ = " + (
            "∞" if np.isinf(high) else f"{high:.2f}"
        )
        axes.plot(t, loss, color=colour, label=f"a ray that {name}: {bounds}")
        axes.axvspan(low, min(high, 2), color=colour, alpha=0.12, linewidth=0)
    axes.set_xlabel("predicted depth t$_{pred}$")
    axes.set_ylabel("loss")
    axes.set_xlim(0, 2)
    axes.grid(linewidth=0.4, alpha=0.4)
    axes.legend()
