"""Stage: one method against the reference, by view [4.1]."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from neural_shadows.evaluation.answers import Answers
from neural_shadows.evaluation.method_names import unbiased
from neural_shadows.evaluation.per_view_metrics import write_metrics
from neural_shadows.evaluation.references import References
from neural_shadows.evaluation.shadow_methods import classic_method
from neural_shadows.evaluation.visibilities import write_visibilities
from neural_shadows.files.whole_files import read_json
from neural_shadows.metrics.available_lpips import lpips_metric
from neural_shadows.metrics.flip import flip
from neural_shadows.metrics.psnr_ssim import psnr, ssim
from neural_shadows.metrics.shadow_error import shadow_error
from neural_shadows.rendering.gbuffer import GBuffer
from neural_shadows.rendering.shading import shade
from neural_shadows.running.progress import progress_bar
from neural_shadows.running.stage import run_stage
from neural_shadows.scenes.scene import open_scene

# Of a frame by its number in the batch: its visibility (n,), and further counts.
Answer = Callable[[int, GBuffer], tuple[np.ndarray, Mapping[str, float]]]


def evaluate(
    references: Path,
    answers: Path | None,
    mesh_ply: Path | None,
    depth_bias_json: Path | None,
    lpips_json: Path,
    metrics_csv: Path,
    visibilities_npz: Path,
    *,
    method: str,
    scene: Mapping[str, Any],
    threads: int = 1,
) -> None:
    """Shade and measure the batch's frames by one method.

    Writes tidy metrics (a row per view and metric), with the numbers of `Violations` where they
    are counted; and the method's visibilities, see `write_visibilities`, to draw any frame.

    Args:
        references: of `render_references`.
        answers: of `query_network`; None for a method without a network.
        mesh_ply: prepared, for such a method.
        depth_bias_json: of `find_depth_bias`, for a method with a bias.
        lpips_json: of `find_lpips`; LPIPS is left out where it is not available.
        method: the method's key.
        scene: `up`, `ground` and `light`, see `open_scene`.

    Raises:
        InputError: an input file cannot be read.
    """
    if answers:
        answer = _of_network(Answers(answers))
    else:
        bias = read_json(depth_bias_json)["depth_bias"] if depth_bias_json else 0.0
        answer = _of_classic(unbiased(method), mesh_ply, scene, bias)
    metrics = {"psnr": psnr, "ssim": ssim, "flip": flip} | lpips_metric(lpips_json, threads)
    batch = References(references)
    rows: list[dict[str, Any]] = []
    lit: list[np.ndarray] = []
    with progress_bar(len(batch), "views", f"evaluate {method}") as bar:
        for number, (frame, truth) in enumerate(batch):
            visibility, counted = answer(number, frame)
            image, reference = shade(frame, visibility), shade(frame, truth)
            lit.append(visibility[frame.lit_side])
            values = {name: metric(image, reference) for name, metric in metrics.items()}
            values |= {**shadow_error(visibility, truth)._asdict(), **counted}
            key = {"view": frame.view.index, "view_set": frame.view.view_set, "method": method}
            rows += [key | {"metric": name, "value": value} for name, value in values.items()]
            bar.update()
    write_visibilities(visibilities_npz, lit)
    write_metrics(metrics_csv, rows)


def _of_network(answers: Answers) -> Answer:
    def answer(number: int, frame: GBuffer) -> tuple[np.ndarray, Mapping[str, float]]:
        counted = answers.violations(number)
        return answers.visibility(number, frame), counted._asdict() if counted else {}

    return answer


def _of_classic(method: str, mesh_ply: Path, scene: Mapping[str, Any], bias: float) -> Answer:
    shadow_method = classic_method(method, open_scene(mesh_ply, **scene))
    return lambda number, frame: (shadow_method(frame)(bias), {})


if "snakemake" in globals():
    run_stage(snakemake, evaluate)
