"""The learning curves of a configuration, one training after another until the time is up."""

import shutil
import time
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import torch
from gpu_data import Data

from neural_shadows.evaluation.per_view_metrics import write_metrics
from neural_shadows.files.whole_files import read_json, whole_file, write_json, write_text
from neural_shadows.layout.layout import Layout
from neural_shadows.metrics.psnr_ssim import psnr, ssim
from neural_shadows.metrics.shadow_error import shadow_error
from neural_shadows.networks.compute import choose_dtype
from neural_shadows.networks.kinds import make_network
from neural_shadows.networks.mesh_surface import with_surface
from neural_shadows.networks.object_space.shadow_network import ShadowNetwork
from neural_shadows.networks.object_space.shadow_query import network_lit, on_device
from neural_shadows.rendering.gbuffer import GBuffer
from neural_shadows.rendering.shading import shade
from neural_shadows.running.origin import describe_origin
from neural_shadows.training.train import outcome, ray_points
from neural_shadows.training.training_run import TrainingRun

Metric = Callable[[np.ndarray, np.ndarray], float]

IMAGE_METRICS: dict[str, Metric] = {"psnr": psnr, "ssim": ssim}

BATCH = "000"  # all views are one batch


def keys_of(settings: Mapping[str, Any]) -> Iterator[str]:
    """The trainings of all learning curves, those that decide most first.

    Experiments come in the order of the configuration. A curve of one seed says something, and
    its seeds together decide: so one experiment after another, and seed by seed.
    """
    for points in settings["learning_curves"].values():
        for point in sorted(points, key=lambda point: (point["seed"], point["steps"])):
            yield point["experiment"]


def run_curves(
    out: Path,
    device: torch.device,
    data: Data,
    deadline: float,
    metrics: Mapping[str, Metric] = IMAGE_METRICS,
) -> list[str]:
    """Train and measure what is not there yet until `deadline` on the monotonic clock.

    Writes, below `out`, what the pipeline writes of each training, where it does (`Paths`):
    `training.json`, `loss.csv` and the metrics, with those of `no_shadow`, and the description of
    the scene's mesh. And, in `out`, the state of the training that was stopped.

    Args:
        metrics: of images, beside the shadow errors.

    Returns: the trainings that are left.
    """
    settings = data.settings
    paths = Layout(settings).paths

    def record(key: str) -> Path:
        return out / paths.network("training.json", key)

    left = [key for key in keys_of(settings) if not record(key).exists()]
    while left and time.monotonic() < deadline:
        key = left[0]
        experiment = settings["experiments"][key]
        scene = experiment["scene"]
        state = out / f"{key}.safetensors"
        run, header = _opened(key, experiment, device, data)
        if state.exists():
            run.restore(state)
        rays, _ = data.rays(scene, experiment["sampling"])
        if not _train(run, rays, deadline, data.threads):
            run.save(state)
            break
        run.save(state)  # measuring takes a minute, and may be cut short
        answers = {key: answers_of(run.network, run.dtype), "no_shadow": all_lit}
        for method, lit in answers.items():
            metrics_csv = out / paths.evaluation("csv", scene, method, BATCH)
            if not metrics_csv.exists():
                write_metrics(metrics_csv, measured(method, lit, data, scene, metrics))
        with whole_file(out / paths.scene("mesh.json", scene)) as part:
            shutil.copy(data.mesh(scene).with_suffix(".json"), part)
        write_text(out / paths.network("loss.csv", key), run.curve_csv())
        # Last, for it says that all else is there.
        about = {"parameters": run.network.parameter_count(), "unfit": False, **describe_origin()}
        about |= outcome(run, rays) | {"threads": data.threads}
        write_json(record(key), header | about)
        state.unlink(missing_ok=True)
        left.remove(key)
    return left


def _opened(key: str, experiment: Mapping[str, Any], device: torch.device, data: Data):
    """A training at its start, and the header of its weights."""
    scene = experiment["scene"]
    dtype = choose_dtype(data.settings["compute"]["precision"], device)
    made = {"device": device.type, "precision": str(dtype).removeprefix("torch.")}
    training = experiment["training"] | {"seed": experiment["seed"]} | made
    settings = with_surface(experiment["network"], {"sheet": False})
    network = make_network(settings)
    if Layout(data.settings).kind(key).needs_mesh:
        network.prepare(data.mesh(scene))
    network.initialise(experiment["seed"])
    _, rays_json = data.rays(scene, experiment["sampling"])
    header = {"name": key, "network": settings, "training": training}
    return TrainingRun(network, training), header | {"data": read_json(rays_json)}


def _train(run: TrainingRun, rays, deadline: float, threads: int) -> bool:
    """Do steps until the end or the deadline; gives whether it came to the end."""
    started, before = time.monotonic(), run.seconds
    for step in ray_points(run, rays, threads, after_step=lambda samples: None):
        run.seconds = before + time.monotonic() - started
        more = step < run.settings["steps"] and run.died_at_step is None
        if time.monotonic() > deadline and more:
            return False
    return True


def answers_of(network: ShadowNetwork, dtype: torch.dtype) -> Callable[[GBuffer], np.ndarray]:
    """What a network says of the points of a frame that face the light: lit or not, (m,) bool."""

    def lit(frame: GBuffer) -> np.ndarray:
        points, light = on_device(frame.p, frame.view.light, network.device)
        return network_lit(network, points, light, dtype=dtype)(0.0).cpu().numpy()

    return lit


def all_lit(frame: GBuffer) -> np.ndarray:
    """The answer of the null predictor."""
    return np.ones(len(frame.lit_side), bool)


def measured(
    method: str,
    lit: Callable[[GBuffer], np.ndarray],
    data: Data,
    scene: str,
    metrics: Mapping[str, Metric],
) -> list[dict[str, Any]]:
    """Rows of a method's metrics on all frames of a scene, see `write_metrics`."""
    frames = data.frames(scene)
    answers = [frame.visibility(lit(frame)) for frame, _ in frames]

    def rows(pair, answer: np.ndarray) -> list[dict[str, Any]]:
        frame, truth = pair
        image, reference = shade(frame, answer), shade(frame, truth)
        values = {name: metric(image, reference) for name, metric in metrics.items()}
        values |= shadow_error(answer, truth)._asdict()
        view = {"view": frame.view.index, "view_set": frame.view.view_set, "method": method}
        return [view | {"metric": name, "value": value} for name, value in values.items()]

    with ThreadPoolExecutor(data.threads) as pool:
        return [row for part in pool.map(rows, frames, answers) for row in part]
