"""Weights that ship: restored whole and fitting, or refused; their model cards."""

import gc

import pytest
import torch
from checkout import ROOT
from screen_frames import write_frames
from served import served
from shipped import shipped as shipped_config

from neural_shadows.config.reading import read_config
from neural_shadows.errors import InputError
from neural_shadows.files.whole_files import read_json, sha256_of, write_json
from neural_shadows.networks.settings.networks import screen_network
from neural_shadows.networks.weight_file import load_tensors
from neural_shadows.reports.data.soft_frames import describe_trainings
from neural_shadows.running.stage import converted
from neural_shadows.training.model_card import model_card
from neural_shadows.training.restore_weights import restore_weights
from neural_shadows.training.ship_weights import LICENCE, SHIPPED, ship_weights
from neural_shadows.training.train_on_frames import train_on_frames

NETWORK = {"form": "kernels", "widths": [4, 8], "filters": 2}
NETWORK |= {"features": ["cosine", "penumbra", "z_b", "base_hard"]}
TRAINING = {
    **{"optimiser": "adam", "steps": 2, "crops": 2, "crop": 16, "learning_rate": 5e-3},
    **{"schedule": "cosine", "alpha": 1.0, "perceptual": {"net": "none"}, "perturbation": 0.0},
    **{"perturbation_from": 0.0, "aligned": False, "flips": False},
}
MEGABYTES = 4e6


@pytest.fixture(scope="module")
def trained(tmp_path_factory):
    """A folder of a training of two steps, as results/networks/NAME."""
    folder = tmp_path_factory.mktemp("networks") / "tiny"
    frames = folder.parent / "few" / "wall"
    arguments = {
        **{"train": [write_frames(frames, count=2)], "trunk": None},
        "validation": [write_frames(frames, "validation")],
        **{"network": NETWORK, "training": TRAINING, "scenes": ["wall"], "lights": None},
        **{"seed": 3, "experiment": "tiny", "device": "cpu", "precision": "float32"},
    }
    files = {"weights": "weights.safetensors", "loss_csv": "loss.csv"}
    paths = {
        key: folder / name for key, name in (files | {"training_json": "training.json"}).items()
    }
    train_on_frames(**paths, **converted(train_on_frames, arguments))
    return folder


@pytest.fixture
def file(trained, tmp_path):
    ship_weights(trained, tmp_path / "shipped" / "tiny.safetensors")
    return tmp_path / "shipped" / "tiny.safetensors"


def restore(folder, file, path=None, sha256=None, network=NETWORK):
    """Restore in `folder`; gives training.json."""
    arguments = {
        **{"file": file, "path": path or str(file), "network": network, "experiment": "mine"},
        "sha256": sha256 or sha256_of(file),
    }
    outputs = folder / "mine" / "weights.safetensors", folder / "mine" / "training.json"
    files = dict(zip(("weights", "training_json"), outputs))
    restore_weights(**files, **converted(restore_weights, arguments))
    return read_json(outputs[1])


def refusal(folder, *arguments, **changes):
    with pytest.raises(InputError) as caught:
        restore(folder, *arguments, **changes)
    assert not [path for path in folder.glob("mine/**/*") if path.is_file()]
    assert "\n" not in str(caught.value)
    return str(caught.value)


def test_a_copy_says_what_the_training_said(trained, file, tmp_path):
    """And the tables say that it is one."""
    restored, record = restore(tmp_path, file), read_json(trained / "training.json")
    assert (tmp_path / "mine/weights.safetensors").read_bytes() == file.read_bytes()
    own = {"shipped": {"path": str(file), "sha256": sha256_of(file)}, "licence": LICENCE}
    assert restored == record | own
    shape = {"width": 64, "height": 32, "layouts": 1}
    uses = {"train": shape | {"frames": 2}, "validation": shape | {"frames": 1}}
    assert record["data"] == {"frame_set": "few", **uses}
    tensors, _ = load_tensors(trained / "weights.safetensors")
    shipped, _ = load_tensors(file)
    assert all(torch.equal(tensors[name], weight) for name, weight in shipped.items())
    both = {"mine": restored, "other": record}
    ours, theirs = describe_trainings(both, {"mine": "Mine", "other": "Other"})
    assert ours.startswith("Weights as shipped, of 2 steps") and ours.endswith(": Mine.")
    assert theirs.startswith("Trained for 2 steps") and theirs.endswith(": Other.")


def test_a_download_is_restored(file, tmp_path):
    digest = sha256_of(file)
    with served(file.parent) as address:
        restored = restore(tmp_path, None, f"{address}tiny.safetensors", digest)
        assert restored["shipped"]["path"].startswith("http://") and restored["parameters"] > 0
        assert {path.name for path in (tmp_path / "mine").iterdir()} == {
            *("weights.safetensors", "training.json")
        }
        said = refusal(tmp_path / "none", None, f"{address}none.safetensors", digest)
        assert "none.safetensors: 404" in said and "`experiments.mine.weights: null`" in said
        file.write_bytes(file.read_bytes()[:1000])
        said = refusal(tmp_path / "cut", None, f"{address}tiny.safetensors", digest)
        assert "does not match the known hash" in said


@pytest.mark.filterwarnings("ignore:unclosed <socket:ResourceWarning")  # of requests
def test_a_server_that_is_not_there(tmp_path):
    said = refusal(tmp_path, None, "http://127.0.0.1:9/tiny.safetensors", "0" * 64)
    assert said.startswith("cannot download http://127.0.0.1:9/tiny.safetensors: ")
    assert "name the file in `experiments.mine.weights.path`" in said
    gc.collect()  # here, not in another test


def test_another_checksum_is_refused(file, tmp_path):
    digest = sha256_of(file)
    file.write_bytes(file.read_bytes()[:1000])
    said = refusal(tmp_path, file, sha256=digest)
    assert said.startswith(
        f"{file}: its SHA-256 is {sha256_of(file)}, and experiments.mine.weights"
    )
    assert f"sha256 = {digest}: cut off, or another file. Take the file again" in said


def test_another_file_is_refused(tmp_path):
    torch.save({}, tmp_path / "weights.pth")
    said = refusal(tmp_path, tmp_path / "weights.pth")
    assert "weights.pth: no weights of a screen-space network of this pipeline" in said
    assert said.endswith("Name others in `experiments.mine.weights`")


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        (
            {"features": ["cosine", "z_b", "base_hard"]},
            "features = ['cosine', 'z_b', 'base_hard'], but these weights have ['cosine', 'penumbra'",
        ),
        ({"widths": [8, 8]}, "widths = [8, 8], but these weights have [4, 8]"),
        ({"form": "direct"}, "form = 'direct', but these weights have 'kernels'"),
    ],
)
def test_weights_of_another_network_are_refused(file, tmp_path, changes, words):
    network = NETWORK | changes
    if "form" in changes:
        network.pop("filters")
    said = refusal(tmp_path, file, network=network)
    assert said.startswith(f"{file}: experiments.mine.network: ") and words in said
    assert said.endswith("Take their value, or train with `experiments.mine.weights: null`")


def test_weights_without_their_training_s_numbers_are_refused(trained, tmp_path):
    said = refusal(tmp_path, trained / "weights.safetensors")
    assert "weights.safetensors: has no parameters, samples" in said
    assert said.endswith("ship_weights results/networks/NAME`")


def test_the_card_has_the_numbers(trained, file):
    card, record = (
        file.with_suffix(".md").read_text(encoding="utf-8"),
        read_json(trained / "training.json"),
    )
    assert card == model_card(file) and len(card.splitlines()) <= 40
    for words in (
        *("# tiny\n", "snakemake reports/answers/FRAMES/tiny.csv", "| seed, commit | 3, "),
        *("`few`", "| training | 2 of 64 × 32 of 1 layouts |", "| budget | 2 steps"),
        *("radius up to 0.25 metres", "`c_e`, `z`, `z_b`", f"| licence | {LICENCE}, as"),
    ):
        assert words in card
    assert "| radius, metres | 0 | 0.25 |\n" in card
    nulls = record["null_mse"]
    for name, errors in {
        "this network": record["validation_mse"],
        **{"base_hard": nulls["base_hard"], "no shadow": nulls["no_shadow"]},
    }.items():
        assert f"| {name} | {' | '.join(f'{1e4 * error:.2f}' for error in errors)} |\n" in card


def copy_of(trained, folder, **changes):
    """A copy of a training, with changes of training.json; `without` a key."""
    folder.mkdir()
    weights = (trained / "weights.safetensors").read_bytes()
    (folder / "weights.safetensors").write_bytes(weights)
    record = read_json(trained / "training.json") | changes
    record.pop(changes.get("without"), None)
    write_json(folder / "training.json", record)
    return folder


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"without": "data"}, "training.json: has no data. Train it again"),
        ({"validation_mse": [0.1, None]}, "tiny.safetensors: validation_mse: is not finite"),
        ({"scenes": ["another"]}, "training.json: scenes: is not that of weights.safetensors"),
    ],
)
def test_a_card_without_its_numbers_is_refused(trained, tmp_path, changes, words):
    folder = copy_of(trained, tmp_path / "tiny", **changes)
    with pytest.raises(InputError, match=words):
        ship_weights(folder, tmp_path / "shipped" / "tiny.safetensors")
    assert not [*tmp_path.glob("shipped/*")]


def test_the_licence_is_this_repository_s():
    assert f"license: {LICENCE}\n" in (ROOT / "CITATION.cff").read_text(encoding="utf-8")


@pytest.mark.parametrize("file", sorted(SHIPPED.glob("*.safetensors")), ids=lambda path: path.stem)
def test_what_ships(file, tmp_path):
    """It is small, has the card of its header, and the experiment of its name restores it."""
    assert file.stat().st_size <= MEGABYTES
    assert file.with_suffix(".md").read_text(encoding="utf-8") == model_card(file), (
        "make it again: PYTHONPATH=workflow python -m neural_shadows.training.ship_weights"
    )
    config = read_config(shipped_config())
    weights = config.experiments[file.stem].weights
    assert weights.path == f"workflow/weights/{file.name}"
    network = config.network_of(file.stem).model_dump()
    restored = restore(tmp_path, file, sha256=weights.sha256, network=network)
    assert screen_network(restored["network"]).model_dump() == network
