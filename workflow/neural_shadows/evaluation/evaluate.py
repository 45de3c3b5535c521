"""The stage that measures one method against the reference on a batch of viewpoints [4.1]."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from neural_shadows.evaluation.first_frames import write_first_frames
from neural_shadows.evaluation.per_view_metrics import write_metrics
from neural_shadows.evaluation.references import References
from neural_shadows.evaluation.shadow_methods import network_method, open_network, traced_method
from neural_shadows.files.whole_files import read_json
from neural_shadows.metrics.flip import flip
from neural_shadows.metrics.psnr_ssim import psnr, ssim
from neural_shadows.metrics.shadow_error import shadow_error
from neural_shadows.rendering.shading import shade
from neural_shadows.running.progress import progress_bar
from neural_shadows.running.stage import run_stage
from neural_shadows.scenes.scene import open_scene


def evaluate(
    references: Path,
    mesh_ply: Path,
    weights: Path | None,
    depth_bias_json: Path | None,
    lpips_json: Path,
    metrics_csv: Path,
    pictures_npz: Path,
    *,
    method: str,
    scene: Mapping[str, Any],
    bias: float | str | None = None,
    device: str = "auto",
    threads: int = 1,
) -> None:
    """Shade the batch's frames by one method, and measure them.

    Writes tidy metrics (a row per view and metric) and, for people to look at, the picture of
    each view set's first frame, see `write_first_frames`.

    Args:
        references: what `render_references` wrote.
        weights: of a network; None for `shadow_map_N`.
        depth_bias_json: what `find_depth_bias` wrote, where `bias` is `held_out`.
        lpips_json: what `find_lpips` wrote; LPIPS is left out where it is not available.
        method: the method's key, `shadow_map_N` or the name that a network goes by.
        scene: `up`, `ground` and `light`, see `open_scene`.
        bias: of a network's depth test, in sphere radii, or `held_out`.

    Raises:
        InputError: an input file cannot be read.
    """
    if weights:
        if depth_bias_json:
            bias = read_json(depth_bias_json)["depth_bias"]
        network, dtype = open_network(weights, device, threads)
        answer = network_method(network, dtype, bias or 0.0)
    else:
        answer = traced_method(method, open_scene(mesh_ply, **scene))
    metrics = {"psnr": psnr, "ssim": ssim, "flip": flip} | _lpips(lpips_json, device, threads)
    batch = References(references)
    rows: list[dict[str, Any]] = []
    pictures: dict[str, np.ndarray] = {}
    with progress_bar(len(batch), "views", f"evaluate {method}") as bar:
        for frame, truth in batch:
            visibility = answer(frame)
            image, reference = shade(frame, visibility), shade(frame, truth)
            pictures.setdefault(frame.view.view_set, image)
            values = {name: metric(image, reference) for name, metric in metrics.items()}
            values |= shadow_error(visibility, truth)._asdict()
            key = {"view": frame.view.index, "view_set": frame.view.view_set, "method": method}
            rows += [key | {"metric": name, "value": value} for name, value in values.items()]
            bar.update()
    write_first_frames(pictures_npz, method, pictures)
    write_metrics(metrics_csv, rows)


def _lpips(lpips_json: Path, device: str, threads: int) -> dict[str, Callable[..., float]]:
    found = read_json(lpips_json)
    if not found["available"]:
        return {}
    # Here and not above: torch and torchvision take 3 s to import.
    import torch

    from neural_shadows.metrics.lpips_distance import make_lpips
    from neural_shadows.networks.compute import choose_device

    torch.set_num_threads(threads)
    trunk = Path(found["trunk"]) if found["trunk"] else None
    return {"lpips": make_lpips(found["net"], trunk, choose_device(device).type)}


if "snakemake" in globals():
    run_stage(snakemake, evaluate)
