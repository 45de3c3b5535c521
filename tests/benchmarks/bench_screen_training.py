"""Training steps of networks of whole frames, beside plain float32 and their convolutions alone.

The ceiling is the rate of what the step's convolutions take in our number format: of the network
once forward and backward and, for the twin, once forward; of the trunk three times forward and once
back. The first layer's input has no gradient. The peer is the same step in float32, all crops at
once, with threads inside each convolution.
"""

import tempfile
from pathlib import Path

import torch
import torchvision
from measurement import Row, median_seconds, name_of, with_threads

from neural_shadows.frames.feature_names import channels_of
from neural_shadows.networks.compute import choose_dtype
from neural_shadows.networks.pretrained_trunk import MODELS
from neural_shadows.networks.screen_space.screen_networks import make_screen_network
from neural_shadows.networks.settings.networks import screen_network
from neural_shadows.training.perceptual import Perceptual
from neural_shadows.training.screen_crops import Crops, CropSample
from neural_shadows.training.screen_loss import ScreenLoss
from neural_shadows.training.screen_run import ScreenRun
from neural_shadows.training.workers import Workers

THREADS, CROPS, SIDE = 2, 4, 256
NSM = {
    "form": "shuffle",
    "widths": [32, 64, 128, 256],
    "features": ["c_e", "view", "ratio", "difference"],
}
KERNELS = {
    "form": "kernels",
    "widths": [32, 32, 64, 128],
    "features": [
        *("cosine", "c_v_by_d", "z_f", "penumbra", "behind", "z_b_by_z", "z_b", "base_msm"),
    ],
}
SETTINGS = {
    **{"steps": 1000, "crops": CROPS, "crop": SIDE, "learning_rate": 1e-3, "schedule": "cosine"},
    **{
        "perturbation": 3.0,
        "perturbation_from": 0.0,
        "aligned": False,
        "flips": True,
        "optimiser": "muon",
        "adam_rate": 3e-3,
        "seed": 0,
        "device": "cpu",
    },
}


class RandomFrames:
    """Crops of noise: the rate does not depend on what they show."""

    height, width, twins, radii = SIDE, 2 * SIDE, 3, 5

    def __init__(self, channels: int):
        generator = torch.Generator().manual_seed(0)
        one, twin = (torch.rand(1, channels, SIDE, SIDE, generator=generator) for _ in range(2))
        valid = torch.ones(1, 1, SIDE, SIDE, dtype=torch.bool)
        self._crops = Crops(one, torch.rand(1, 1, SIDE, SIDE), valid, twin, valid, None)

    def __len__(self) -> int:
        return 1

    def crop(self, place: CropSample, side: int, aligned: bool) -> Crops:
        """The same each time."""
        return self._crops


def rows(quick: bool) -> list[Row]:
    """Neural Shadow Mapping with L1 alone and with the perceptual term; kernels with L1."""
    with tempfile.TemporaryDirectory() as folder:
        trunk = Path(folder) / "trunk.pth"
        model = torchvision.models.get_model(MODELS["squeeze"], weights=None)
        torch.save(model.features.state_dict(), trunk)
        cases = [(NSM, None), (NSM, trunk), (KERNELS, None)]
        return [_row(network, path, 3 if quick else 9) for network, path in cases]


def _run(network: dict, precision: str, trunk: Path | None) -> ScreenRun:
    cpu = torch.device("cpu")
    dtype = choose_dtype(precision, cpu)
    perceptual = None if trunk is None else Perceptual("squeeze", trunk, cpu, dtype)
    loss = ScreenLoss(0.9, 3.0, perceptual)
    loss.factor = 1.0
    settings = SETTINGS | {"precision": precision}
    frames = RandomFrames(channels_of(network["features"]))
    return ScreenRun(make_screen_network(screen_network(network)), settings, frames, loss)


class WholeBatch(ScreenRun):
    """All crops in one chunk, as plain PyTorch has it."""

    def _gather(self, step: int, pool):
        chunks, count = super()._gather(step, pool)
        return [Crops.joined(chunks)], count


def _convolutions(run: ScreenRun, trunk: Path | None):
    """What a chunk's convolutions do in a step, each alone on inputs of its shapes."""
    layers = []

    def note(again: int, to_weight: bool):
        def hook(layer, inputs, output):
            x, y = (torch.randn_like(one, dtype=run.dtype) for one in (inputs[0], output))
            x, y = (one.contiguous(memory_format=torch.channels_last) for one in (x, y))
            weight = layer.weight.detach().to(run.dtype)
            transposed = isinstance(layer, torch.nn.ConvTranspose2d)
            # A layer that pads by itself before the convolution has no padding of its own.
            border = layer.kernel_size[0] // 2 if x.shape[2:] == y.shape[2:] else layer.padding[0]
            shape = layer.stride, (border, border), (1, 1), transposed, (0, 0), 1
            layers.append((x, y, weight, shape, again, (bool(layers), to_weight)))

        return hook

    features = run._gather(0, _Here())[0][0].features
    parts = [(run._working_copy, 2, True)]
    if trunk is not None:
        parts.append((run.loss._perceptual._layers, 3, False))
    hooks = [
        layer.register_forward_hook(note(again, to_weight))
        for part, again, to_weight in parts
        for layer in part.modules()
        if isinstance(layer, torch.nn.Conv2d | torch.nn.ConvTranspose2d)
    ]
    with torch.no_grad():
        output = run.predict(features)
        run.loss.terms(output, torch.ones_like(output, dtype=torch.bool), [], 1)
    for hook in hooks:
        hook.remove()

    def work() -> None:
        with torch.no_grad():
            for x, y, weight, shape, again, gradients in layers:
                for _ in range(again):
                    torch.convolution(x, weight, None, *shape)
                torch.ops.aten.convolution_backward(
                    *(y, x, weight, None), *shape, [*gradients, False]
                )

    return work, CROPS // len(features)


def _row(network: dict, trunk: Path | None, rounds: int) -> Row:
    ours, plain = (_run(network, precision, trunk) for precision in ("auto", "float32"))
    plain.__class__ = WholeBatch
    pool = Workers(THREADS)
    convolutions, chunks = _convolutions(ours, trunk)
    products = [convolutions] * chunks

    works = {
        "ours": with_threads(1, lambda: ours.train_step(0, pool)),
        "plain": with_threads(THREADS, lambda: plain.train_step(0, _Here())),
        "convolutions": with_threads(1, lambda: list(pool.map(lambda work: work(), products))),
    }
    seconds = median_seconds(works, rounds)
    pixels = CROPS * SIDE**2
    named = f"{network['form']}, {'L1' if trunk is None else 'L1 and SqueezeNet'}"
    return Row(
        f"training whole frames, {named}, {name_of(ours.dtype)}",
        f"cpu x{THREADS}",
        pixels / seconds["ours"],
        "pixels/s",
        ceiling=pixels / seconds["convolutions"],
        peer="eager float32, all crops at once",
        peer_rate=pixels / seconds["plain"],
    )


class _Here:
    """Computes where it is asked, as a pool of this thread."""

    map = staticmethod(map)
