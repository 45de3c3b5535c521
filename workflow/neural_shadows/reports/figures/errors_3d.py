"""Where methods err: false shadow and light leak as points on the scene, in three dimensions."""

from collections.abc import Sequence
from itertools import islice
from pathlib import Path

import numpy as np

from neural_shadows.evaluation import shadow_methods
from neural_shadows.evaluation.method_names import unbiased
from neural_shadows.evaluation.references import References
from neural_shadows.files.whole_files import read_json
from neural_shadows.reports.figures import space
from neural_shadows.reports.figures.hero_view import hero_view
from neural_shadows.reports.figures.style import FALSE_SHADOW, LIGHT_LEAK, Section
from neural_shadows.running.stage import run_stage
from neural_shadows.scenes.scene import open_scene

MOST_VIEWS = 12  # of a batch; a network answers for each
MOST_POINTS = 20_000
COLOURS = {"false shadow": FALSE_SHADOW, "light leak": LIGHT_LEAK}


def draw(
    mesh_ply: Path,
    references: Path,
    weights: list[Path],
    depth_biases: list[Path],
    png: Path,
    svg: Path,
    *,
    title: str,
    scene: Section,
    rows: Sequence[Section],
    run: Section,
    device: str = "auto",
    precision: str = "auto",
    threads: int = 1,
) -> None:
    """Draw the wrong points of a batch of viewpoints by each method.

    Args:
        references: of the batch.
        weights, depth_biases: of the rows' experiments.
        device, precision: that networks are asked with, see `open_network`.

    Raises:
        InputError: an input file is missing or not whole, or there is no OpenGL.
    """
    opened = open_scene(mesh_ply, **scene)
    networks = {path.parent.name: path for path in weights}
    held_out = {path.stem: path for path in depth_biases}
    shown = {}
    for row in rows:
        name = unbiased(row["method"])
        found = held_out[name] if row["bias"] == "held_out" else None
        if row["experiment"] is None:
            bias = read_json(found)["depth_bias"] if found else 0.0
            method = shadow_methods.classic_method(name, opened)
        else:
            path = networks[row["experiment"]]
            network, dtype = shadow_methods.open_network(path, device, threads, precision)
            bias = shadow_methods.take_found(network, found) if found else row["bias"]
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
    method: shadow_methods.ShadowMethod, bias: float, batch: References
) -> tuple[np.ndarray, np.ndarray, float]:
    """Points (k, 3) where a method with a depth bias errs, the sign of the error (k,), and the share of all points.

    At most `MOST_POINTS` near the object; the share is of all points that face the light.
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
