"""What else users bring: a configuration, and a trunk for LPIPS."""

import pytest
import torch
import torchvision
import yaml
from corpus.damage import changed_bytes, changed_numbers, reads, strangers
from hypothesis import given
from shipped import shipped

from neural_shadows.config import reading
from neural_shadows.config.reading import check_duplicates, check_files, read_config
from neural_shadows.errors import InputError
from neural_shadows.metrics.lpips_trunk import read_trunk

OVERLAY = b"""
scale: mine
networks:
  small: {frequencies: 4, width: 64, hidden_layers: 2}
trainings:
  short: {steps: 20, batch_size: 256, learning_rate: 0.001}
"""


def read_overlay(path):
    """As Snakemake merges it. Messages on a value name its key and not the file."""
    check_duplicates([path])
    # By the same loader: libyaml takes some tabs that Python's does not.
    values = yaml.load(path.read_text(), reading._NoDuplicates)
    try:
        check_files(read_config(shipped(**{str(key): value for key, value in values.items()})))
    except InputError as error:
        assert str(error).startswith("config: ")
        raise InputError(f"{error} [{path.name}]") from error


def overlay(tmp_path, content):
    (tmp_path / "mine.yaml").write_bytes(content)
    return reads(read_overlay, tmp_path / "mine.yaml")


def test_in_the_place_of_an_overlay(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert overlay(tmp_path, OVERLAY)
    for name, content in strangers().items():
        assert not overlay(tmp_path, content), name
    for content in (
        b"scale: mine\nscale: yours\n",
        b"scale: [1\n",
        b"\tscale: mine\n",
        b"scenes: 3\n",
        b"scenes: {dragon: {mesh: {path: no_such_file.ply}}}\n",
        b"x: !!python/object/apply:os.system [touch pickle_ran]\n",
        b"scale: &a [*a]\n",
    ):
        assert not overlay(tmp_path, content), content
    assert [path.name for path in tmp_path.iterdir()] == ["mine.yaml"]


def test_drawn_overlays(tmp_path):
    @given(changed_bytes(OVERLAY) | changed_numbers(OVERLAY))
    def check(content):
        overlay(tmp_path, content)

    check()


def trunk(tmp_path, content):
    (tmp_path / "trunk.pth").write_bytes(content)
    return reads(lambda path: read_trunk("squeeze", path), tmp_path / "trunk.pth")


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    path = tmp_path_factory.mktemp("whole") / "trunk.pth"
    torch.manual_seed(0)
    torch.save(torchvision.models.squeezenet1_1(weights=None).features.state_dict(), path)
    return path


def test_in_the_place_of_a_trunk(tmp_path, monkeypatch, whole):
    monkeypatch.chdir(tmp_path)
    assert trunk(tmp_path, whole.read_bytes())
    for name, content in strangers().items():
        assert not trunk(tmp_path, content), name
    state, key = torch.load(whole, weights_only=True), "0.weight"
    for name, changed in {
        "a list": list(state.values()),
        "no tensors": {},
        "a word": state | {key: "weights"},
        "another shape": state | {key: state[key][:5]},
        "complex": state | {key: state[key].to(torch.complex64)},
        "NaN": state | {key: state[key] * torch.nan},
    }.items():
        torch.save(changed, tmp_path / "changed")
        content = (tmp_path / "changed").read_bytes()
        assert not trunk(tmp_path, content), name
    assert not (tmp_path / "pickle_ran").exists()


def test_drawn_trunks(tmp_path, whole):
    @given(changed_bytes(whole.read_bytes()))
    def check(content):
        trunk(tmp_path, content)

    check()
