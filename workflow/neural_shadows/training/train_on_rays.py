"""Stage: train a shadow network on a ray set [3.5, 4.1].

Resumable and reproducible from the seed. An untrained one, such as a decimated mesh, is only built.
"""

import time
from pathlib import Path
from typing import Any

import torch

from neural_shadows.files.whole_files import read_json, write_json, write_text
from neural_shadows.networks.compute import choose_device, choose_dtype
from neural_shadows.networks.kind_module import kind_module
from neural_shadows.networks.kinds import make_network
from neural_shadows.networks.mesh_surface import is_unfit, with_surface
from neural_shadows.networks.object_space.shadow_network import ShadowNetwork
from neural_shadows.networks.settings.networks import RayNetwork
from neural_shadows.networks.weight_file import save_network
from neural_shadows.rays.ray_set import RaySet
from neural_shadows.running.origin import describe_origin
from neural_shadows.running.stage import run_stage
from neural_shadows.settings.records import WeightsHeader
from neural_shadows.training.batches import DeviceRays, batch_indices, batch_source
from neural_shadows.training.checkpoints import STAGES, STATE, checkpoint_folder
from neural_shadows.training.cuda_graph import recorded
from neural_shadows.training.loss_curve import COLUMNS
from neural_shadows.training.no_shadow import no_shadow_loss
from neural_shadows.training.settings.rays import RayTraining
from neural_shadows.training.steps import train_to_end
from neural_shadows.training.training_run import TrainingRun
from neural_shadows.training.workers import Workers


def train_on_rays(
    *,
    mesh_ply: Path | None,
    weights: Path,
    loss_csv: Path,
    training_json: Path,
    network: RayNetwork,
    training: RayTraining | None,
    seed: int,
    experiment: str,
    directions_npy: Path | None = None,
    origins: list[Path] = (),
    bounds: list[Path] = (),
    rays_json: Path | None = None,
    mesh_json: Path | None = None,
    device: str = "auto",
    precision: str = "auto",
    threads: int = 1,
    run_cores: int = 0,
) -> None:
    """Train one network, the thesis's with Adam and dead-zone loss.

    See [3.5, 4.1]. A killed run, called again with the same arguments, continues from its
    checkpoint, and on a CPU ends in the same weights as an uninterrupted one (a GPU adds the
    gradients of grids in any order). A final checkpoint stays, see `checkpoints.remove_finished`. A
    diverged run, see `TrainingRun.died_at_step`, ends there with a warning. Its weights are
    written: divergence is a result.

    Args:
        mesh_ply, mesh_json: outputs of `prepare_mesh`, for a network that needs them; None for
            others.
        weights: in a folder of the experiment's, with `checkpoints` beside it.
        training_json: for the settings and their results: `samples`, `seconds` (with the layout),
            `final_loss`, `died_at_step`, `no_shadow_loss` of the null predictor without shadow; and
            `unfit`, see `is_unfit`.
        network: its `surface: auto` is the mesh's.
        training: None for an untrained network, which needs no rays.
        directions_npy, origins, bounds, rays_json: of the ray set; the weights' header has its
            description.
        precision: of the matrix products, see `choose_dtype`.
        threads, run_cores: of `Workers`; the weights do not depend on them.

    Raises:
        InputError: a missing or damaged file, or an optimiser unfit for this network.
    """
    torch.set_num_threads(1)  # the pool's threads work side by side
    mesh = {"sheet": False} if mesh_json is None else read_json(mesh_json)
    network = with_surface(network, mesh)
    if mesh_ply is not None:
        # Warm-up: otherwise `seconds` would include compiling kernels and loading libraries, for a
        # DAG of 1024³ voxels 8.3 s instead of 0.73.
        make_network(network).prepare(mesh_ply)
    started = time.monotonic()  # includes the layout before training
    header = {"name": experiment, "network": network.model_dump()}
    header |= {"training": None, "data": None}
    if training is not None:
        torch_device = choose_device(device)
        dtype = str(choose_dtype(precision, torch_device)).removeprefix("torch.")
        platform = {"seed": seed, "device": torch_device.type, "precision": dtype}
        header |= {"training": {**training.model_dump(), **platform}, "data": read_json(rays_json)}
    model = make_network(network)
    if mesh_ply is not None:
        model.prepare(mesh_ply)
    model.initialise(seed)
    if training is not None:
        rays = RaySet(directions_npy, origins, bounds)
        cores = (threads, run_cores)
        result, curve = _train(model, header, rays, weights, cores, started)
    else:
        seconds = round(time.monotonic() - started, 1)
        result = {"samples": 0, "seconds": seconds, "samples_per_second": None}
        result |= {"final_loss": None, "no_shadow_loss": None, "died_at_step": None, "threads": 1}
        curve = ",".join(COLUMNS) + "\n"

    save_network(weights, model, header)
    write_text(loss_csv, curve)
    record = {"parameters": model.parameter_count(), "unfit": is_unfit(network, mesh), **result}
    write_json(training_json, {**header, **record, **describe_origin()})


def _train(
    model: ShadowNetwork,
    header: WeightsHeader,
    rays: RaySet,
    weights: Path,
    cores: tuple[int, int],
    started: float,
) -> tuple[dict[str, Any], str]:
    """Train a network; return its results and the loss curve as CSV."""
    run = TrainingRun(model, header["training"])
    code = (STAGES / "train_on_rays.py", kind_module(header["network"]["encoding"]))
    checkpoint = checkpoint_folder(weights, header, code)
    if (checkpoint / STATE).exists():
        run.restore(checkpoint / STATE)
    source = batch_source(rays, run.device)
    batches = {key: run.settings[key] for key in ("seed", "batch_size")} | {"count": rays.count}
    with Workers(*cores, run.chunks) as workers:
        # One thread feeds a GPU, so that its stream can be recorded.
        on_cpu = workers if run.device.type == "cpu" else None

        def advance() -> None:
            run.train_step(source.gather(batch_indices(run.step, **batches)), on_cpu)

        if run.network.recordable and isinstance(source, DeviceRays):
            advance = recorded(advance)
        train_to_end(run, advance, header["name"], checkpoint, started)
    result = {**run.outcome(), "died_at_step": run.died_at_step, "threads": workers.most}
    return {**result, "no_shadow_loss": no_shadow_loss(rays, run.dead_zone)}, run.curve_csv()


if "snakemake" in globals():
    run_stage(snakemake, train_on_rays)
