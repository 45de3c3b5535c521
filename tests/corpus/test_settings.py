"""What else users bring: a configuration, and a trunk for LPIPS."""

import io
from functools import partial

import torch
import torchvision
import yaml
from corpus.damage import check_reader, reads
from shipped import shipped

from neural_shadows.config import reading
from neural_shadows.config.reading import check_files, read_config, read_sections
from neural_shadows.errors import InputError
from neural_shadows.networks.pretrained_trunk import read_trunk

OVERLAY = b"""
scale: mine
networks:
  small: {frequencies: 4, width: 64, hidden_layers: 2}
trainings:
  short: {steps: 20, batch_size: 256, learning_rate: 0.001}
learning_curves: {on_rays: {experiments: [dragon], steps: [5, 10, 20], seeds: 2}}
claims:
  sampling: {metrics: [psnr], needs: {seeds: 2, device: cpu}}
"""


def read_overlay(path):
    """As Snakemake merges it. Messages on a value name its key and not the file."""
    read_sections(path)
    # By the same loader: libyaml takes some tabs that Python's does not.
    values = yaml.load(path.read_text(), reading._NoDuplicates)
    try:
        check_files(read_config(shipped(**{str(key): value for key, value in values.items()})))
    except InputError as error:
        raise InputError(f"{error} [{path.name}]") from error


def test_overlays(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "mine.yaml"
    check_reader(read_overlay, path, OVERLAY)
    for content in (
        b"\tscale: mine\n",
        b"3",
        b"x: !!python/object/apply:os.system [touch pickle_ran]\n",
        b"scale: &a [*a]\n",
    ):
        path.write_bytes(content)
        assert not reads(read_overlay, path), content
    assert not (tmp_path / "pickle_ran").exists()


def test_trunks(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    saved = io.BytesIO()
    torch.save(torchvision.models.squeezenet1_1(weights=None).features.state_dict(), saved)
    check_reader(partial(read_trunk, "squeeze"), tmp_path / "trunk.pth", saved.getvalue())
