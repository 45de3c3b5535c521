"""False shadow and light leaks as points, in 3D."""

from collections.abc import Mapping, Sequence
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Literal

import numpy as np
from pydantic import Field

from neural_shadows.evaluation.look import FALSE_SHADOW, LIGHT_LEAK
from neural_shadows.evaluation.method_names import unbiased
from neural_shadows.files.whole_files import read_json
from neural_shadows.layout import tables
from neural_shadows.layout.layout import Layout
from neural_shadows.reports.drawing import space
from neural_shadows.reports.drawing.hero_view import hero_view
from neural_shadows.reports.tables import comparison, networks
from neural_shadows.running.stage import run_stage
from neural_shadows.sections.table_figures import MethodsFigure
from neural_shadows.settings.records import Row, Run

if TYPE_CHECKING:
    from neural_shadows.evaluation.references import References
    from neural_shadows.evaluation.shadow_methods import ShadowMethod

USES_GPU = True
MOST_VIEWS = 12  # of a batch; a network is evaluated for each
MOST_POINTS = 20_000
COLOURS = {"false shadow": FALSE_SHADOW, "light leak": LIGHT_LEAK}


class Settings(MethodsFigure):
    """The errors of methods on the mesh, in 3D."""

    tables = (comparison.Settings, networks.Settings)
    needs_opengl: ClassVar[bool] = True

    kind: Literal["errors_3d"] = Field(description="`errors_3d`")


def files(layout: Layout, figure: str) -> dict[str, Any]:
    settings = layout.entry("figures", figure)
    rows, scene = settings["rows"], settings["scene"]
    return {
        "mesh_ply": layout.paths.scene("mesh.ply", scene),
        "references": layout.paths.reference(scene, "000"),
        "weights": tables.networks(layout, rows, "weights.safetensors"),
        "depth_biases": tables.depth_biases(layout, rows),
    }


def params(layout: Layout, figure: str) -> dict[str, Any]:
    settings, compute = layout.entry("figures", figure), layout.settings["compute"]
    return {
        "scene": layout.entry("scenes", settings["scene"])["scene"],
        "rows": settings["rows"],
        "run": layout.run(),
        "device": compute["device"],
        "precision": compute["precision"],
    }


def encodings(layout: Layout, figure: str) -> set[str]:
    rows = layout.entry("figures", figure)["rows"]
    return layout.encodings(tables.experiments_of(rows))


def draw(
    mesh_ply: Path,
    references: Path,
    weights: list[Path],
    depth_biases: list[Path],
    png: Path,
    svg: Path,
    *,
    title: str,
    scene: Mapping[str, Any],
    rows: Sequence[Row],
    run: Run,
    device: str = "auto",
    precision: str = "auto",
    threads: int = 1,
) -> None:
    """Draw each method's wrong points in a batch of viewpoints.

    Args:
        references: of the batch.
        weights, depth_biases: of the rows' experiments.
        device, precision: of networks, see `open_network`.

    Raises:
        InputError: an input file is missing or not whole, or there is no OpenGL.
    """
    from neural_shadows.evaluation import shadow_methods
    from neural_shadows.evaluation.references import References
    from neural_shadows.scenes.scene import open_scene

    opened = open_scene(mesh_ply, **scene)
    weight_paths = {path.parent.name: path for path in weights}
    bias_paths = {path.stem: path for path in depth_biases}
    shown = {}
    for row in rows:
        name = unbiased(row["method"])
        bias_path = bias_paths[name] if row["bias"] == "held_out" else None
        if row["experiment"] is None:
            bias = read_json(bias_path)["depth_bias"] if bias_path else 0.0
            method = shadow_methods.classic_method(name, opened)
        else:
            path = weight_paths[row["experiment"]]
            network, dtype = shadow_methods.open_network(path, device, threads, precision)
            bias = shadow_methods.take_found(network, bias_path) if bias_path else row["bias"]
            method = shadow_methods.network_method(network, dtype)
        p, error, share = wrong_points(method, bias, References(references))
        plotter = space.new_plotter(hero_view(opened.up, 4.1))
        space.add_object(plotter, opened)
        space.add_ground(plotter, opened)
        for sign, colour in zip((-1, 1), COLOURS.values()):
            if np.any(error == sign):
                plotter.add_points(p[error == sign], color=colour, point_size=5, lighting=False)
        shown[f"{row['label']}\n{share:.2%} of the points wrong"] = plotter
    title = f"{title} ({run['scale']} scale)"
    space.write_pictures(shown, png, svg, title=title, colours=COLOURS)


def wrong_points(
    method: "ShadowMethod", bias: float, batch: "References"
) -> tuple[np.ndarray, np.ndarray, float]:
    """Wrong points of a method, and their share.

    Returns: points (k, 3), at most `MOST_POINTS` near the object, the sign of each error (k,), and
    the share of wrong points among all that face the light.
    """
    points, errors = [], []
    for frame, truth in islice(batch, 0, None, 1 + (len(batch) - 1) // MOST_VIEWS):
        errors.append(np.sign(np.round(method(frame)(bias)) - np.round(truth))[frame.lit_side])
        points.append(frame.p)
    p, error = np.concatenate(points), np.concatenate(errors)
    near = (error != 0) & (np.linalg.norm(p, axis=1) < 1.1 * space.REACH)
    shown = np.flatnonzero(near)[:: 1 + np.count_nonzero(near) // MOST_POINTS]
    return p[shown], error[shown], np.count_nonzero(error) / max(len(error), 1)


if "snakemake" in globals():
    run_stage(snakemake, draw)
