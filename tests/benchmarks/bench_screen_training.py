"""Training steps of a network of whole frames, beside plain float32 and its convolutions alone.

The ceiling is the rate of what the step's convolutions take in our number format: of the network
once forward and backward and, for the twin, once forward; of the trunk three times forward and once
back. The peer is the same step in float32, all crops at once, with threads inside each convolution.
"""

import tempfile
from pathlib import Path

import torch
import torchvision
from measurement import Row, median_seconds, name_of, with_threads

from neural_shadows.networks.compute import choose_dtype
from neural_shadows.networks.pretrained_trunk import MODELS
from neural_shadows.networks.screen_space.screen_networks import make_screen_network
from neural_shadows.networks.settings.networks import screen_network
from neural_shadows.training.perceptual import Perceptual
from neural_shadows.training.screen_crops import Crops, CropSample
from neural_shadows.training.screen_loss import ScreenLoss
from neural_shadows.training.screen_run import ScreenRun
from neural_shadows.training.training_state import gradient_pool

THREADS, CROPS, SIDE = 2, 4, 256
NETWORK = {
    "form": "shuffle",
    "widths": [32, 64, 128, 256],
    "features": ["c_e", "view", "ratio", "difference"],
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

    def __init__(self):
        generator = torch.Generator().manual_seed(0)
        one, twin = (torch.rand(1, 4, SIDE, SIDE, generator=generator) for _ in range(2))
        valid = torch.ones(1, 1, SIDE, SIDE, dtype=torch.bool)
        self._crops = Crops(one, torch.rand(1, 1, SIDE, SIDE), valid, twin, valid, None)

    def __len__(self) -> int:
        return 1

    def crop(self, place: CropSample, side: int, aligned: bool) -> Crops:
        """The same each time."""
        return self._crops


def rows(quick: bool) -> list[Row]:
    """With L1 alone, and with the perceptual term."""
    with tempfile.TemporaryDirectory() as folder:
        trunk = Path(folder) / "trunk.pth"
        model = torchvision.models.get_model(MODELS["squeeze"], weights=None)
        torch.save(model.features.state_dict(), trunk)
        return [_row(path, 3 if quick else 9) for path in (None, trunk)]


def _run(precision: str, trunk: Path | None) -> ScreenRun:
    cpu = torch.device("cpu")
    dtype = choose_dtype(precision, cpu)
    perceptual = None if trunk is None else Perceptual("squeeze", trunk, cpu, dtype)
    loss = ScreenLoss(0.9, 3.0, perceptual)
    loss.factor = 1.0
    settings = SETTINGS | {"precision": precision}
    return ScreenRun(make_screen_network(screen_network(NETWORK)), settings, RandomFrames(), loss)


class WholeBatch(ScreenRun):
    """All crops in one chunk, as plain PyTorch has it."""

    def _gathered(self, step: int, pool):
        chunks, count = super()._gathered(step, pool)
        return [Crops.joined(chunks)], count


def _convolutions(run: ScreenRun, trunk: Path | None):
    """What a crop's convolutions do in a step, each alone on inputs of its shapes."""
    layers = []

    def note(again: int, gradient: tuple[bool, bool]):
        def hook(layer, inputs, output):
            x, y = (torch.randn_like(one, dtype=run.dtype) for one in (inputs[0], output))
            x, y = (one.contiguous(memory_format=torch.channels_last) for one in (x, y))
            weight = layer.weight.detach().to(run.dtype)
            # A layer that pads by itself before the convolution has no padding of its own.
            border = layer.kernel_size[0] // 2 if x.shape[2:] == y.shape[2:] else layer.padding[0]
            layers.append((x, y, weight, layer.stride, border, again, gradient))

        return hook

    crops = run.frames.crop(None, SIDE, False)
    parts = [(run._working_copy, 2, (True, True))]
    if trunk is not None:
        parts.append((run.loss._perceptual._layers, 3, (True, False)))
    hooks = [
        layer.register_forward_hook(note(again, gradient))
        for part, again, gradient in parts
        for layer in part.modules()
        if isinstance(layer, torch.nn.Conv2d)
    ]
    with torch.no_grad():
        run.loss.terms(run.predict(crops.features), crops.valid, [], 1)
    for hook in hooks:
        hook.remove()

    def work() -> None:
        with torch.no_grad():
            for x, y, weight, stride, border, again, (to_input, to_weight) in layers:
                for _ in range(again):
                    torch.nn.functional.conv2d(x, weight, None, stride, border)
                torch.ops.aten.convolution_backward(
                    *(y, x, weight, None, stride, (border, border), (1, 1), False, (0, 0), 1),
                    [to_input, to_weight, False],
                )

    return work


def _row(trunk: Path | None, rounds: int) -> Row:
    ours, plain = _run("auto", trunk), _run("float32", trunk)
    plain.__class__ = WholeBatch
    pool = gradient_pool(THREADS)
    convolutions = _convolutions(ours, trunk)
    products = [convolutions] * CROPS

    works = {
        "ours": with_threads(1, lambda: ours.train_step(0, pool)),
        "plain": with_threads(THREADS, lambda: plain.train_step(0, _Here())),
        "convolutions": with_threads(1, lambda: list(pool.map(lambda work: work(), products))),
    }
    seconds = median_seconds(works, rounds)
    pixels = CROPS * SIDE**2
    named = "L1" if trunk is None else "L1 and SqueezeNet"
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
