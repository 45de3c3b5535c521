"""Names and lifetime of checkpoints."""

import pytest

from neural_shadows.networks.kind_module import kind_module
from neural_shadows.running.module_graph import PACKAGE
from neural_shadows.training import checkpoints
from neural_shadows.training.checkpoints import (
    CHECKPOINTS,
    STAGES,
    checkpoint_folder,
    remove_finished,
)

KIND = kind_module("frequency")
HEADER = {
    "name": "ball",
    "network": {"encoding": "frequency", "width": 8},
    "training": {"steps": 20, "loss": {"false_shadow": 1.0}, "precision": "float32"},
    "data": {"rays": 20_000},
}


def folder_of(tmp_path, header=HEADER, kind=KIND):
    weights = tmp_path / "networks" / "ball" / "weights.safetensors"
    return checkpoint_folder(weights, header, (STAGES / "train_on_rays.py", kind))


@pytest.mark.parametrize("change", [{"name": "balls"}, {"data": {"rays": 20_001}}])
def test_other_settings_have_another_checkpoint(tmp_path, change):
    ours = folder_of(tmp_path)
    assert ours.parent == tmp_path / "networks" / CHECKPOINTS
    assert ours == folder_of(tmp_path) != folder_of(tmp_path, HEADER | change)


def test_other_code_of_the_network_s_class_has_another_checkpoint(tmp_path, monkeypatch):
    """Its settings' file is no part of it: a description changes no weights."""
    network = PACKAGE / "networks/object_space/frequency_network.py"
    ours = folder_of(tmp_path)
    assert ours == folder_of(tmp_path, kind=network)
    digested = []
    monkeypatch.setattr(
        checkpoints, "digest", lambda modules: digested.append(modules) or "another"
    )
    assert folder_of(tmp_path) != ours
    assert network in digested[0] and KIND not in digested[0]


def test_checkpoints_of_finished_networks_are_removed(tmp_path):
    names = ("dragon-1a", "dragon-2b", "dragon_64-3c", "fence-4d")
    folders = [tmp_path / CHECKPOINTS / name for name in names]
    for folder in folders:
        folder.mkdir(parents=True)
        (folder / "state.safetensors").write_text("state")
    for name in ("dragon", "other"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "weights.safetensors").write_text("weights")
    (tmp_path / "fence").mkdir()  # Snakemake makes it before the training
    remove_finished(tmp_path)
    assert [folder.exists() for folder in folders] == [False, False, True, True]
    assert (tmp_path / "dragon" / "weights.safetensors").exists()
