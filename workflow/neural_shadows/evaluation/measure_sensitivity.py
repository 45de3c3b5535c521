"""Stage: sensitivity of a network to each of its features."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import torch

from neural_shadows.files.whole_files import write_json
from neural_shadows.frames.feature_names import FEATURES
from neural_shadows.frames.features import named_features
from neural_shadows.frames.frame_set import FrameSetPart
from neural_shadows.networks.screen_space.screen_networks import load_screen_network
from neural_shadows.running.origin import describe_origin
from neural_shadows.running.progress import progress_bar
from neural_shadows.running.stage import run_stage

NOISE = 0.1  # of a feature's standard deviation (Datta et al. 2022, eq. 1)


def measure_sensitivity(
    parts: list[Path],
    weights: Path,
    sensitivity_json: Path,
    *,
    seed: int,
    frames: int = 4,
    repeats: int = 2,
    threads: int = 1,
) -> None:
    """Add noise to one feature at a time (3.2, eq. 1).

    As printed the difference is signed, and its mean over noise of both signs is 0: ours is
    absolute. Divided by the noise's standard deviation it has the unit of 1 / feature, so that a
    length in millimetres would count a thousandth of one in metres: the share is of features with
    a standard deviation of 1, and the form as printed stands beside it.

    Args:
        parts: of validation frames. seed: of the noise.
        sensitivity_json: `features`, of each `sensitivity`, `share` of their sum, and `as_printed`.
        frames: number of frames, spread over all, each for all radii.
        repeats: of the noise.

    Raises:
        InputError: a file is damaged.
    """
    torch.set_num_threads(threads)
    network, _ = load_screen_network(weights)
    network = network.eval().to(memory_format=torch.channels_last)
    names = network.features
    offsets = np.cumsum([0, *(FEATURES[name] for name in names)])
    images = [*_features(parts, names, frames)]
    values = np.concatenate([image[:, valid] for image, valid in images], axis=1)
    # A vector's width is the mean of its components'.
    widths = [values[a:b].std(axis=1).mean() for a, b in zip(offsets, offsets[1:])]
    rng = np.random.default_rng(seed)
    changes = np.zeros(len(names))
    with progress_bar(len(images) * repeats, "frames", "sensitivity") as bar:
        for image, valid in images:
            unchanged = _evaluated(network, image)
            for _ in range(repeats):
                for k, (a, b) in enumerate(zip(offsets, offsets[1:])):
                    noisy = image.copy()
                    noise = rng.standard_normal(image[a:b].shape, np.float32)
                    noisy[a:b] += np.float32(NOISE * widths[k]) * noise
                    changes[k] += np.abs(_evaluated(network, noisy) - unchanged)[valid].mean()
                bar.update()
    sensitivity = changes / (len(images) * repeats) / NOISE
    printed = np.divide(sensitivity, widths, out=np.zeros_like(sensitivity), where=widths != 0)
    by_feature = {
        name: {"sensitivity": s, "share": s / sensitivity.sum(), "as_printed": p}
        for name, s, p in zip(names, sensitivity, printed)
    }
    about = {"frames": len(images), "repeats": repeats, "noise": NOISE, "seed": seed}
    write_json(sensitivity_json, {"features": by_feature, **about, **describe_origin()})


def _features(
    parts: list[Path], names: tuple[str, ...], count: int
) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Features (C, H, W) for each radius, with valid pixels. Of `count` frames."""
    opened = [FrameSetPart(path) for path in parts]
    numbered = [(part, number) for part in opened for number in range(len(part))]
    for part, number in numbered[:: max(1, len(numbered) // count)][:count]:
        lens = part.lens(number)
        buffers = {name: part.image(number, name) for name in part.about["channels"]}
        for radius in part.radii:
            yield (
                named_features(names, buffers, lens, part.light_size(radius)),
                part.valid[number, 0],
            )


def _evaluated(network: torch.nn.Module, features: np.ndarray) -> np.ndarray:
    planes = torch.from_numpy(features)[None].contiguous(memory_format=torch.channels_last)
    with torch.inference_mode():
        return network(planes)[0, 0].clamp(0, 1).numpy()


if "snakemake" in globals():
    run_stage(snakemake, measure_sensitivity)
