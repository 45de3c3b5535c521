"""Networks on rays: a GPU's answers and trainings beside those of a CPU."""

import json
from pathlib import Path
from unittest import mock

import pytest
import torch
import trimesh
from built_networks import laid_out, make_network
from rays import ball_batch, open_rays, write_ball_rays

from neural_shadows.networks.compute import choose_dtype
from neural_shadows.networks.weight_file import load_network
from neural_shadows.running.stage import converted
from neural_shadows.training import steps
from neural_shadows.training.batches import DeviceRays, HostRays, batch_indices, batch_source
from neural_shadows.training.loss_curve import read_loss
from neural_shadows.training.train_on_rays import train_on_rays
from neural_shadows.training.training_run import TrainingRun

RAYS = 20_000
GPU = torch.device("cuda")
THESIS = {"encoding": "frequency", "frequencies": 3, "width": 64, "hidden_layers": 2}
FIELD = {"encoding": "occupancy_field", "resolution": 16, "surface": "solid", "stored": "int8"}
GRIDS = {
    "encoding": "hash_grid",
    "points": 2,
    "grids": [4, 8],
    "channels": 2,
    "width": 8,
    "hidden_layers": 1,
    "head": "depth_confidence",
    "stored": "float32",
    "occupancy": 8,
    "table_size": 64,
}
KINDS = pytest.mark.parametrize("settings", [THESIS, FIELD, GRIDS], ids=lambda s: s["encoding"])
TRAINING = {
    "optimiser": "adam",
    "steps": 200,
    "batch_size": 512,
    "learning_rate": 5e-3,
    "schedule": "cosine",
    "loss": {"false_shadow": 1.0},
}


def network_of(settings: dict, folder: Path):
    if settings["encoding"] == "frequency":
        network = make_network(settings)
        network.initialise(1)
        return network
    return laid_out(trimesh.creation.icosphere(3, radius=0.5), folder, settings)


def train(folder: Path, *, settings=THESIS, stop_after=None, **changes) -> dict:
    """Train on a ball in `folder`, stopped in a checkpoint after some points of the loss curve."""
    folder.mkdir(exist_ok=True)
    results = folder / "ball"
    arguments = {
        "network": settings,
        "training": TRAINING,
        "seed": 1,
        "experiment": "ball",
        "mesh_ply": None,
        "precision": "float32",
        "device": "cuda",
    } | changes
    if settings["encoding"] != "frequency":
        trimesh.creation.icosphere(3, radius=0.5).export(folder / "mesh.ply")
        arguments["mesh_ply"] = folder / "mesh.ply"
    saved = 0
    save = TrainingRun.save

    def save_and_stop(self, path):
        nonlocal saved
        save(self, path)
        saved += 1
        if saved == stop_after:
            raise KeyboardInterrupt

    with (
        mock.patch.object(TrainingRun, "save", save_and_stop),
        mock.patch.object(steps, "CHECKPOINT_SECONDS", 0.0 if stop_after else 1e9),
    ):
        train_on_rays(
            weights=results / "weights.safetensors",
            loss_csv=results / "loss.csv",
            training_json=results / "training.json",
            **write_ball_rays(folder, RAYS),
            **converted(train_on_rays, arguments),
        )
    return json.loads((results / "training.json").read_text())


def weights_of(folder: Path) -> list[torch.Tensor]:
    return [*load_network(folder / "ball" / "weights.safetensors")[0].state_dict().values()]


@KINDS
def test_depths_are_those_of_the_cpu(tmp_path, settings):
    """Depths of the same rays by the same weights."""
    network, batch = network_of(settings, tmp_path), ball_batch(RAYS)
    depths = network(batch.origins, batch.directions, torch.float32).detach()
    network.to(GPU)
    on_gpu = type(batch)(*(part.to(GPU) for part in batch))
    for dtype, tolerance in ((torch.float32, 1e-3), (torch.bfloat16, 0.05), (torch.float16, 0.01)):
        answer = network(on_gpu.origins, on_gpu.directions, dtype).detach().cpu()
        # Field and grids look into cells: at a border a rounding moves a ray into the next.
        unlike = (answer - depths).abs() > tolerance
        assert unlike.float().mean() < 0.01, (dtype, unlike.float().mean())


def test_batches_are_those_of_the_cpu(tmp_path):
    write_ball_rays(tmp_path, RAYS)
    rays = open_rays(tmp_path)
    source = batch_source(rays, GPU)
    assert isinstance(source, DeviceRays)
    how = {"seed": 3, "batch_size": 512, "count": RAYS}
    for step in (0, 7):
        indices = batch_indices(torch.tensor(step, device=GPU), **how)
        expected = batch_indices(torch.tensor(step), **how)
        assert torch.equal(indices.cpu(), expected)
        theirs = HostRays(rays, torch.device("cpu")).gather(expected)
        for ours, other in zip(source.gather(indices), theirs):
            assert torch.equal(ours.cpu(), other)


def test_a_recorded_training_gives_the_same_bytes(tmp_path):
    """The replayed graph does just what its steps do one by one."""
    train(tmp_path / "recorded")
    with mock.patch("neural_shadows.training.train_on_rays.recorded", lambda step: step):
        train(tmp_path / "plain")
    for ours, theirs in zip(weights_of(tmp_path / "recorded"), weights_of(tmp_path / "plain")):
        assert torch.equal(ours, theirs)


@pytest.mark.parametrize("optimiser", ["adam", "muon"])
@pytest.mark.parametrize("precision", ["float32", "bfloat16", "float16"])
def test_the_thesiss_training_ends_where_the_cpu_s_does(tmp_path, precision, optimiser):
    rates = {"adam_rate": 5e-3} if optimiser == "muon" else {}
    training = TRAINING | {"optimiser": optimiser, **rates}
    gpu = train(tmp_path / "gpu", precision=precision, training=training)
    cpu = train(tmp_path / "cpu", device="cpu", training=training)
    assert (gpu["training"]["device"], gpu["training"]["precision"]) == ("cuda", precision)
    assert gpu["final_loss"] == pytest.approx(cpu["final_loss"], rel=0.15)
    first = [
        read_loss(tmp_path / where / "ball" / "loss.csv")["loss"][0] for where in ("gpu", "cpu")
    ]
    # Of the same weights. From the second step on float16 differs by up to 6 %.
    assert first[0] == pytest.approx(first[1], rel=0.02)


@KINDS
def test_resumes(tmp_path, settings):
    """The thesis's to the byte; gradients of grids are added in any order."""
    train(tmp_path / "whole", settings=settings)
    with pytest.raises(KeyboardInterrupt):
        train(tmp_path / "killed", settings=settings, stop_after=40)
    train(tmp_path / "killed", settings=settings)
    for ours, theirs in zip(weights_of(tmp_path / "killed"), weights_of(tmp_path / "whole")):
        if settings is THESIS:
            assert torch.equal(ours, theirs)
        else:
            assert torch.allclose(ours.float(), theirs.float(), rtol=0.02, atol=0.02 * 127)


def test_auto_takes_bfloat16():
    assert choose_dtype("auto", GPU) == torch.bfloat16
