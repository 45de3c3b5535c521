"""False shadow and light leaks as points, in 3D."""

from collections.abc import Sequence
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Literal

import numpy as np
from pydantic import Field

from neural_shadows.evaluation.look import FALSE_SHADOW, LIGHT_LEAK
from neural_shadows.evaluation.registry import unbiased
from neural_shadows.layout.layout import Layout
from neural_shadows.reports.drawing import space
from neural_shadows.reports.drawing.style import Figure
from neural_shadows.reports.tables import comparison, networks
from neural_shadows.sections.table_figures import MethodsFigure
from neural_shadows.settings.records import Row, SceneSettings

if TYPE_CHECKING:
    from neural_shadows.evaluation.method import ShadowMethod
    from neural_shadows.evaluation.references import References

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
    scene = layout.entry("figures", figure)["scene"]
    return {"references": layout.paths.reference(scene, "000")}


def draw(
    mesh_ply: Path,
    references: Path,
    weights: list[Path],
    depth_biases: list[Path],
    heading: str,
    scene: SceneSettings,
    rows: Sequence[Row],
    device: str = "auto",
    precision: str = "auto",
) -> Figure:
    """Draw each method's wrong points in a batch of viewpoints.

    Args:
        references: of the batch.
        weights, depth_biases: of the rows' experiments.
        device, precision: of networks, see `open_network`.
    """
    from neural_shadows.evaluation import ray_network
    from neural_shadows.evaluation.frame import constants_of
    from neural_shadows.evaluation.references import References
    from neural_shadows.evaluation.registry import classic_method
    from neural_shadows.scenes.scene import open_scene

    opened = open_scene(mesh_ply, **scene)
    weight_paths = {path.parent.name: path for path in weights}
    bias_paths = {path.stem: path for path in depth_biases}
    shown = {}
    for row in rows:
        name = unbiased(row["method"])
        bias_path = bias_paths[name] if row["bias"] == "held_out" else None
        if row["experiment"] is None:
            bias = constants_of(bias_path)[0]["depth_bias"] if bias_path else 0.0
            method = classic_method(name, opened)
        else:
            path = weight_paths[row["experiment"]]
            network, dtype = ray_network.open_network(path, device, 1, precision)
            bias = ray_network.take_constants(network, bias_path) if bias_path else row["bias"]
            method = ray_network.network_method(network, dtype)
        p, error, share = wrong_points(method, bias, References(references))
        plotter, _ = space.object_plotter(opened, 4.1, ground=True)
        for sign, colour in zip((-1, 1), COLOURS.values()):
            if np.any(error == sign):
                plotter.add_points(p[error == sign], color=colour, point_size=5, lighting=False)
        shown[f"{row['label']}\n{share:.2%} of the points wrong"] = plotter
    return space.pictures(shown, title=heading, colours=COLOURS)


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
