"""Training of screen-space networks: convergence, reproducibility, resuming."""

import itertools
import json
from pathlib import Path
from unittest import mock

import numpy as np
import pytest
import torch
from screen_frames import FEATURES, HEIGHT, SETTING, TRAINING, WIDTH, write_frames

from neural_shadows.errors import InputError
from neural_shadows.frames.buffers import CHANNELS
from neural_shadows.frames.setting import setting_of
from neural_shadows.networks.screen_space.screen_networks import load_screen_network
from neural_shadows.rendering.gbuffer import axis_cosines
from neural_shadows.running.stage import converted
from neural_shadows.training import steps
from neural_shadows.training.crop_samples import crop_samples
from neural_shadows.training.screen_batches import ScreenFrames
from neural_shadows.training.screen_crops import CropSample
from neural_shadows.training.screen_run import ScreenRun
from neural_shadows.training.screen_validation import (
    mse_by_radius,
    null_predictors,
    spread_images,
)
from neural_shadows.training.train_on_frames import train_on_frames

SETTINGS = {
    "network": {"form": "shuffle", "widths": [4, 8], "features": FEATURES},
    "training": TRAINING,
    **{"scenes": ["wall"], "lights": None, "seed": 1, "experiment": "nsm", "trunk": None},
    **{"device": "cpu", "precision": "float32", "threads": 1},
}
EXPONENT = {"form": "shuffle", "widths": [4, 8], "features": [*FEATURES, "behind"]}
EXPONENT |= {"answer": "exponent"}
KERNELS = {"form": "kernels", "widths": [4, 8], "filters": 2}
KERNELS |= {"features": ["cosine", "penumbra", "z_b", "base_hard"]}
COSINE = {"schedule": "cosine"}
TRAIN_STEP = ScreenRun.train_step


def run(folder: Path, part: Path, *, stop_after=None, **changes) -> dict:
    """Train in `folder`; gives what training.json says.

    Args:
        stop_after: KeyboardInterrupt in the step after so many, each with a checkpoint.
    """

    def step(self, number, pool):
        if number == stop_after:
            raise KeyboardInterrupt
        TRAIN_STEP(self, number, pool)

    arguments = {"train": [part], "validation": [part], **SETTINGS, **changes}
    results = folder / "nsm"
    paths = [results / name for name in ("weights.safetensors", "loss.csv", "training.json")]
    seconds = steps.CHECKPOINT_SECONDS if stop_after is None else 0.0
    with (
        mock.patch.object(ScreenRun, "train_step", step),
        mock.patch.object(steps, "CHECKPOINT_SECONDS", seconds),
    ):
        files = dict(zip(("weights", "loss_csv", "training_json"), paths))
        train_on_frames(**files, **converted(train_on_frames, arguments))
    return json.loads(paths[2].read_text())


def contents(folder: Path) -> list[bytes]:
    return [(folder / "nsm" / name).read_bytes() for name in ("weights.safetensors", "loss.csv")]


def test_learns_frames_without_the_hard_map(tmp_path):
    """As a user's own may be; then nothing is said of it."""
    part = write_frames(tmp_path)
    about, file = json.loads(part.read_text()), part.with_suffix(".buffers.npy")
    numbers = [number for number, name in enumerate(about["channels"]) if name != "hard"]
    part.write_text(json.dumps(about | {"channels": [about["channels"][k] for k in numbers]}))
    np.save(file, np.load(file)[:, :, numbers])
    assert [*run(tmp_path, part)["null_mse"]] == ["no_shadow"]


def test_overfits_a_frame(tmp_path):
    """A hard shadow and the softest at once: the size is told apart, and no sign is wrong."""
    part = write_frames(tmp_path)
    training = TRAINING | {"steps": 200, "crop": 64, "crops": 4, "learning_rate": 3e-3}
    training |= {"perturbation": 0, "flips": False}
    network = SETTINGS["network"] | {"widths": [32, 64, 128]}
    result = run(tmp_path, part, network=network, training=training)
    assert result["null_mse"]["hard_map"][1] > 0.01
    # Of the hard shadow 0.0003 to 0.0010, over four seeds.
    assert max(result["validation_mse"]) < 2e-3
    assert result["train_mse"] == result["validation_mse"]  # of the same frame
    assert result["train_null_mse"] == result["null_mse"]
    assert [entry["step"] for entry in result["validations"]] == list(range(20, 201, 20))
    assert result["validations"][-1]["mse"] == result["validation_mse"]
    assert result["samples"] == 200 * 4 * HEIGHT * WIDTH
    network, header = load_screen_network(tmp_path / "nsm" / "weights.safetensors")
    arguments = {"features": FEATURES, "radii": [0, 0.25], "scenes": ["wall"], "perceptual": "none"}
    assert header.items() >= arguments.items() and network.features == tuple(FEATURES)


@pytest.mark.usefixtures("any_format")
@pytest.mark.parametrize(
    ("network", "optimiser", "precision", "schedule"),
    [
        (SETTINGS["network"], "adam", "float32", COSINE),
        (SETTINGS["network"], "muon", "bfloat16", COSINE),
        (EXPONENT, "muon", "bfloat16", COSINE),
        (KERNELS, "muon", "float32", COSINE),
        (KERNELS, "adam", "bfloat16", {"schedule": "steps", "tenth_from": [2, 5]}),
    ],
)
def test_resumes_and_does_not_depend_on_threads(tmp_path, network, optimiser, precision, schedule):
    part = write_frames(tmp_path, count=3)
    training = TRAINING | {"optimiser": optimiser, "adam_rate": 1e-3, "crops": 4, **schedule}
    training |= {"aligned": network == KERNELS}
    arguments = {"network": network, "training": training, "precision": precision}
    run(tmp_path / "whole", part, **arguments)
    with pytest.raises(KeyboardInterrupt):
        run(tmp_path / "killed", part, stop_after=4, **arguments)
    assert [*(tmp_path / "killed").glob("checkpoints/nsm-*/state.safetensors")]
    killed = run(tmp_path / "killed", part, **arguments)
    threads = run(tmp_path / "threads", part, threads=2, **arguments)
    run(tmp_path / "other", part, seed=2, **arguments)
    whole = contents(tmp_path / "whole")
    assert contents(tmp_path / "killed") == contents(tmp_path / "threads") == whole
    assert contents(tmp_path / "other") != whole
    assert [entry["step"] for entry in killed["validations"]] == [1, 2, 3, 4, 5, 6]
    # In the file too they are the same, key by key.
    assert json.dumps(killed["validations"]) == json.dumps(threads["validations"])
    bases = ["base_hard"] if network == KERNELS else []  # what it is given is no merit of its own
    assert [*killed["null_mse"]] == ["no_shadow", "hard_map", *bases]


@pytest.mark.parametrize("network", [KERNELS, EXPONENT])
def test_a_batch_that_is_lit_everywhere_is_no_divergence(tmp_path, network):
    """Whatever the weights, a filter of what is lit is lit."""
    part = write_frames(tmp_path)
    file = part.with_suffix(".buffers.npy")
    buffers = np.load(file)
    buffers[:, :, [CHANNELS.index(name) for name in ("hard", "pcf", "msm")]] = 1
    buffers[:, :, CHANNELS.index("gap")] = 0
    np.save(file, buffers)
    assert run(tmp_path, part, network=network)["died_at_step"] is None


def test_frames_written_anew_are_trained_on_anew(tmp_path):
    """The checkpoint of an interrupted training is of others, if below the same description."""
    part = write_frames(tmp_path)
    with pytest.raises(KeyboardInterrupt):
        run(tmp_path / "killed", part, stop_after=4)
    targets = part.with_suffix(".targets.npy")
    np.save(targets, 1 - np.load(targets))
    killed = run(tmp_path / "killed", part)
    assert killed["final_loss"] == run(tmp_path / "whole", part)["final_loss"]
    assert contents(tmp_path / "killed") == contents(tmp_path / "whole")


def test_an_exponent_trains_on_logarithms(tmp_path):
    """It leaves what the map shows lit as it is, whatever its light, and darkens what lies behind."""
    part = write_frames(tmp_path)
    training = TRAINING | {"steps": 60, "crop": 64, "perturbation": 0, "optimiser": "adam"}
    result = run(tmp_path, part, network=EXPONENT, training=training)
    assert result["null_mse"]["no_shadow"][0] > 0.3 and result["validation_mse"][0] < 1e-3
    # Of a soft shadow the half beyond the map's edge is beyond it: 8 columns of 62, of 0 to a half.
    beyond = np.mean((np.arange(0.5, 4) / 8 - 0.5) ** 2) * 4 / 62
    assert beyond < result["validation_mse"][1] < result["null_mse"]["hard_map"][1] * 1.05


def test_an_identical_perturbed_frame_changes_nothing(tmp_path):
    """With zero jitter the loss against the twin is zero."""
    part = write_frames(tmp_path, shift=0.0)
    moved = write_frames(tmp_path / "moved", shift=2.0)
    one_step = TRAINING | {"steps": 1, "crop": 64}
    losses = [
        run(tmp_path / str(number), path, training=one_step | {"perturbation": weight})[
            "final_loss"
        ]
        for number, (path, weight) in enumerate([(part, 0), (part, 3.0), (moved, 3.0)])
    ]
    assert losses[0] == losses[1] < losses[2]


def test_perturbed_frames_begin_late(tmp_path):
    part = write_frames(tmp_path, shift=2.0)
    losses = []
    for weight, share in ((0, 0.0), (3.0, 0.5), (3.0, 0.2), (3.0, 0.0)):
        training = TRAINING | {"steps": 2, "crop": 64, "perturbation": weight}
        training |= {"perturbation_from": share}
        run(tmp_path / f"{weight} {share}", part, training=training)
        curve = (tmp_path / f"{weight} {share}" / "nsm" / "loss.csv").read_text().splitlines()
        losses.append([float(line.split(",")[-1]) for line in curve[1:]])
    none, half, fifth, whole = losses
    assert none[0] == half[0] == fifth[0] < whole[0]
    assert none[1] < half[1] == fifth[1]


def test_crops_depend_on_seed_and_step_alone(tmp_path):
    frames = ScreenFrames([write_frames(tmp_path, count=3)], FEATURES)
    arguments = {"crops": 50, "crop": 16, "flips": True, "twins": True}
    drawn = crop_samples(frames, 7, seed=1, **arguments)
    assert (
        drawn
        == crop_samples(frames, 7, seed=1, **arguments)
        != crop_samples(frames, 8, seed=1, **arguments)
    )
    assert {sample.frame for sample in drawn} == {0, 1, 2} and {p.radius for p in drawn} == {0, 1}
    assert {p.mirrored for p in drawn} == {p.upside_down for p in drawn} == {False, True}
    assert max(sample.left for sample in drawn) <= WIDTH - 16
    for sample in drawn[:8]:
        crop = frames.crop(sample, 16)
        whole = np.float32(frames.target(sample.frame, sample.radius))
        window = whole[sample.top :, sample.left :][:16, :16][:, :: -1 if sample.mirrored else 1]
        assert np.array_equal(crop.target[0, 0].numpy()[:: -1 if sample.upside_down else 1], window)


def test_features_are_normalised_by_all_valid_pixels_of_frames_and_lights(tmp_path):
    """Of 40 frames every third; a normal has three channels, here without any spread."""
    frames = ScreenFrames([write_frames(tmp_path, count=40)], [*FEATURES, "n"])
    pixels = [
        frames.features(frame, radius)[:, frames.valid(frame)]
        for frame in range(0, 40, 3)
        for radius in range(2)
    ]
    pixels = np.concatenate(pixels, axis=1).astype(np.float64)
    means, deviations = frames.ranges()
    assert np.allclose(means, pixels.mean(axis=1), rtol=1e-6, atol=1e-7)
    assert len(means) == 7 and (deviations[-3:] == 1).all()
    assert np.allclose(deviations[:4], pixels[:4].std(axis=1), rtol=1e-5)


def test_images_of_validations_are_spread_over_frames_and_lights(tmp_path):
    frames = ScreenFrames([write_frames(tmp_path, count=10)], FEATURES)
    assert spread_images(frames, 20) == [
        (frame, radius) for radius in (0, 1) for frame in range(10)
    ]
    few = spread_images(frames, 6)
    assert few == [(0, 0), (3, 0), (6, 0), (1, 1), (5, 1), (8, 1)]
    assert [radius for _, radius in spread_images(frames, 1)] == [0, 1]
    # Each light's error is of its own frames.
    lit = null_predictors(frames)["no_shadow"]
    by_radius = mse_by_radius(frames, lit, few)
    own = [
        np.mean(
            [np.square(1 - frames.target(*image)[frames.valid(image[0])]).mean() for image in part]
        )
        for part in (few[:3], few[3:])
    ]
    assert by_radius == pytest.approx(own, rel=1e-3)


def test_crops_of_chosen_lights(tmp_path):
    frames = ScreenFrames([write_frames(tmp_path)], FEATURES)
    arguments = {"seed": 1, "crops": 20, "crop": 16, "flips": False, "twins": False, "lights": [1]}
    for pairs in (False, True):
        assert {entry.radius for entry in crop_samples(frames, 3, pairs=pairs, **arguments)} == {1}


def test_radii_of_a_pair_differ(tmp_path):
    part = write_frames(tmp_path)
    arguments = {"seed": 1, "crops": 60, "crop": 16, "flips": False, "twins": False, "pairs": True}
    frames = ScreenFrames([part], FEATURES)
    drawn = crop_samples(frames, 3, **arguments)
    assert all(entry.radius != other.radius for entry, other in zip(drawn[::2], drawn[1::2]))
    assert {sample.radius for sample in drawn[::2]} == {0, 1}


def test_aligned_perturbed_frames_show_the_same(tmp_path):
    """A wall whose edge the twin sees 2 pixels farther right, from 2 pixels farther left."""
    part = write_frames(tmp_path, shift=2.0)
    about = json.loads(part.read_text())
    camera = setting_of(SETTING).camera
    aside = [-2.0 / camera.focal(HEIGHT), 0.0, 0.0]
    moved = {name: np.add(SETTING[name], aside).tolist() for name in ("eye", "target")}
    about["frames"][0]["twins"] = [SETTING | moved]
    part.write_text(json.dumps(about))
    buffers = np.load(part.with_suffix(".buffers.npy"))
    buffers[:, :, CHANNELS.index("d")] = 1 / axis_cosines(camera, WIDTH, HEIGHT) / about["size"]
    np.save(part.with_suffix(".buffers.npy"), buffers)
    frames = ScreenFrames([part], ["base_hard"])
    for turns in itertools.product((False, True), repeat=2):
        crop = frames.crop(CropSample(0, 0, 1, 4, 14, *turns), 24, aligned=True)
        shown = crop.twin.flatten()[crop.twin_at.flatten()].view_as(crop.twin)
        assert torch.equal(shown[crop.twin_valid], crop.features[crop.twin_valid])
        assert not torch.equal(crop.twin[crop.twin_valid], crop.features[crop.twin_valid])
        assert crop.twin_valid.sum() == 24 * (24 - 2)  # of the rim the twin's crop has nothing
    (outside,) = frames.crop(CropSample(0, 0, 1, 4, 0, False, False), 24, aligned=True).twin_valid[
        0
    ]
    assert torch.equal(outside.all(0), torch.arange(24) < 22)


def test_running_statistics_are_kept_in_the_weights(tmp_path):
    """Of what its first norm has seen: not those that it starts from."""
    training = TRAINING | {"perturbation": 0}
    run(tmp_path, write_frames(tmp_path), network=KERNELS, training=training)
    network, _ = load_screen_network(tmp_path / "nsm" / "weights.safetensors")
    assert all((norm.running_var != 1).all() for norm in network.norms())


@pytest.mark.parametrize("stem", ["buffers", "targets"])
def test_nan_is_refused(tmp_path, stem):
    part = write_frames(tmp_path)
    array = np.load(part.with_suffix(f".{stem}.npy"))
    array[...] = np.nan
    np.save(part.with_suffix(f".{stem}.npy"), array)
    with pytest.raises(InputError, match="train_000.json: NaN or infinity .* frame 0. Delete"):
        run(tmp_path, part)
    assert not (tmp_path / "nsm" / "weights.safetensors").exists()


def test_missing_perturbed_frames_are_refused(tmp_path):
    with pytest.raises(InputError, match="no perturbed frames.*or set `perturbation: 0`"):
        run(tmp_path, write_frames(tmp_path, twins=0))


def test_missing_channels_are_refused(tmp_path):
    part = write_frames(tmp_path)
    about = json.loads(part.read_text())
    channels = [name for name in about["channels"] if name != "z"]
    part.write_text(json.dumps(about | {"channels": channels}))
    with pytest.raises(InputError, match="train_000.json: channels .*; should be z and others"):
        run(tmp_path, part)


RAYS = KERNELS | {"features": ["cosine", "ray_penumbra", "log_d", "base_rays"], "edge": 0.1}


def test_filters_rays(tmp_path):
    """Of a penumbra of 8 of 62 pixels two rays have p (1 − p) / 2, 1 / 12 on average; it has less."""
    training = TRAINING | {"steps": 150, "crop": 32, "crops": 4, "learning_rate": 3e-3}
    part = write_frames(tmp_path, twins=0, rays=2)
    result = run(tmp_path, part, network=RAYS, training=training | {"perturbation": 0})
    assert result["null_mse"]["base_rays"][1] == pytest.approx(8 / 62 / 6 / 2, rel=0.3)
    assert result["null_mse"]["base_rays"][0] == 0
    assert result["validation_mse"][1] < 0.5 * result["null_mse"]["base_rays"][1]
    _, header = load_screen_network(tmp_path / "nsm" / "weights.safetensors")
    assert header["rays"] == 2 and header["network"]["edge"] == 0.1


@pytest.mark.parametrize(("rays", "message"), [(0, "no rays of its frames"), (2, "perturbed")])
def test_rays_that_are_missing(tmp_path, rays, message):
    with pytest.raises(InputError, match=f"{message}.*`rays: 1` or more.*`perturbation: 0`"):
        run(tmp_path, write_frames(tmp_path, rays=rays), network=RAYS)
