"""Methods against the reference on a batch of viewpoints, in one process [4.1]."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import torch

from neural_shadows.evaluation.shadow_methods import (
    map_visibilities,
    network_visibilities,
    reference_of,
)
from neural_shadows.files.whole_files import whole_file, write_text
from neural_shadows.metrics.flip import Flip
from neural_shadows.metrics.lpips_choice import read_lpips_choice
from neural_shadows.metrics.lpips_distance import Lpips
from neural_shadows.metrics.psnr_ssim import psnr, ssim
from neural_shadows.metrics.shadow_error import shadow_error
from neural_shadows.networks.compute import choose_device
from neural_shadows.rendering.scene_frames import open_scene
from neural_shadows.rendering.shading import shade, visibility
from neural_shadows.running.progress import progress_bar


def frame_metrics(
    image: np.ndarray,
    reference: np.ndarray,
    flip: Flip,
    lpips: Lpips | None,
    reference_features: Any,
) -> dict[str, float]:
    """Image metrics of a frame (H, W); without `lpips` its value is left out.

    `flip` and the features are the reference's, made once for all frames compared with it.
    """
    values = {
        "psnr": psnr(image, reference),
        "ssim": ssim(image, reference),
        "flip": flip.mean(image),
    }
    if lpips is not None:
        values["lpips"] = lpips.distance(image, reference_features)
    return values


def evaluate(
    mesh_ply: Path,
    lpips_json: Path,
    weights: Mapping[str, Path],
    depth_biases: Mapping[str, float],
    metrics_csv: Path,
    pictures_npz: Path,
    *,
    shadow_maps: Sequence[int],
    view_set: str,
    first: int,
    last: int,
    frames: Mapping[str, Any],
    reference: str,
    device: str = "auto",
    precision: str = "auto",
    threads: int = 1,
) -> None:
    """Render viewpoints `first` to `last` (exclusive) of a set with every method; measure them.

    Frames, references and what FLIP and LPIPS see of these are made once and shared by all methods. Writes
    tidy metrics (a row per view, method and metric) and, for people to look at, the batch's
    first frame by every method (8-bit grey arrays by method, and `reference`).

    Args:
        lpips_json: what `lpips_stage` wrote.
        weights: weight files by the key of the method.
        depth_biases: of the network query, in sphere radii, by the same keys.
        frames: how they are drawn and rendered, see `open_scene`.
        reference: `exact` or `shadow_map`.

    Raises:
        InputError: an input file is not whole, or a setting does not fit the scene.
    """
    torch.set_num_threads(threads)
    scene = open_scene(mesh_ply, **frames)
    reference_lit = reference_of(scene.mesh, scene.tracer, reference)
    methods = [
        map_visibilities(scene.mesh, scene.tracer, shadow_maps),
        network_visibilities(weights, depth_biases, device=device, precision=precision),
    ]
    found = read_lpips_choice(lpips_json)
    lpips = None
    if found["available"]:
        trunk = Path(found["trunk"]) if found["trunk"] else None
        lpips = Lpips(found["net"], trunk, device=choose_device(device).type)

    rows: list[dict[str, Any]] = []
    pictures: dict[str, np.ndarray] = {}
    viewpoints = scene.viewpoints([view_set], range(first, last))
    with progress_bar(len(viewpoints), "views", f"{view_set} {first}–{last - 1}") as bar:
        for view in viewpoints:
            points = scene.points(view)
            lit = reference_lit(points)
            truth = shade(points, lit)
            flip = Flip(truth)
            features = lpips.features(truth) if lpips else None
            truth_visible = visibility(points, lit)
            everything = np.ones(len(points.pixel), bool)
            images = {"reference": truth}
            for method, lit in (item for part in methods for item in part(points).items()):
                images[method] = shade(points, lit)
                values = frame_metrics(images[method], truth, flip, lpips, features)
                error = shadow_error(visibility(points, lit), truth_visible, everything)
                values |= {
                    "shadow_error": error.total,
                    "false_shadow": error.false_shadow,
                    "light_leak": error.light_leak,
                }
                rows += [
                    {
                        "view": view.index,
                        "view_set": view.view_set,
                        "method": method,
                        "metric": metric,
                        "value": value,
                    }
                    for metric, value in values.items()
                ]
            if not pictures:
                pictures = {
                    method: np.round(255 * image).astype(np.uint8)
                    for method, image in images.items()
                }
            bar.update()

    with whole_file(pictures_npz) as part:
        np.savez_compressed(part, **pictures)
    write_text(metrics_csv, pd.DataFrame(rows).to_csv(index=False, lineterminator="\n"))
