"""Figures of the method, by kind."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from neural_shadows.errors import InputError
from neural_shadows.meshes.mesh_report import read_mesh_report
from neural_shadows.meshes.prepared_mesh import read_prepared
from neural_shadows.reports.figures.dead_zone_loss import _dead_zone_loss
from neural_shadows.reports.figures.dual_bounds import _dual_bounds
from neural_shadows.reports.figures.mesh_slice import slice_mesh
from neural_shadows.reports.figures.overview import _overview
from neural_shadows.reports.figures.quadtree import _quadtree
from neural_shadows.reports.figures.shadow_boundary import _shadow_boundary
from neural_shadows.reports.figures.style import DPI, write_strip
from neural_shadows.reports.figures.view_directions import _view_directions
from neural_shadows.scenes.lights import axis_vector
from neural_shadows.scenes.tracing import Tracer

if TYPE_CHECKING:
    pass


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
