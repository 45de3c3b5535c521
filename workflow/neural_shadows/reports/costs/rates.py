"""Rates of this machine for what jobs compute, measured in seconds."""

import resource
import subprocess
import sys
import time
from collections.abc import Callable
from typing import TypedDict

import numpy as np
import torch
import trimesh

from neural_shadows.networks.compute import choose_device, choose_dtype, finished
from neural_shadows.running.one_thread import one_thread
from neural_shadows.scenes.tracing import Tracer

SECONDS = 1.5  # of each measurement
START = "import pandas, scipy.ndimage, torch, trimesh"  # what most jobs import


class Rates(TypedDict):
    """Rates of one thread, or of a GPU.

    `products` and `convolutions`, 10⁹ multiply-adds a second in `precision` on `device`; occlusion
    `rays`, 10⁶ a second; `loops`, 10⁶ exponentials a second, for all work without a rate of its own;
    `start`, processor seconds of a process.
    """

    products: float
    convolutions: float
    rays: float
    loops: float
    start: float
    device: str
    precision: str


def measure_rates(device: str, precision: str) -> Rates:
    """Measure what networks, rays, loops and process starts take here.

    Args:
        device, precision: of the networks, see `choose_dtype`.
    """
    chosen = choose_device(device)
    dtype = choose_dtype(precision, chosen)
    with one_thread():
        return {
            "products": _products(chosen, dtype),
            "convolutions": _convolutions(chosen, dtype),
            "rays": _rays(),
            "loops": _loops(),
            "start": _start(),
            "device": chosen.type,
            "precision": str(dtype).removeprefix("torch."),
        }


# Each piece of work takes milliseconds, less than a turn of a busy machine's processes: the least of
# their times is the same there. With 15 other processes on two cores the rate of products kept 97 %,
# that of two threads fell to 4 %: jobs' threads are therefore counted, not measured.


def _products(device: torch.device, dtype: torch.dtype) -> float:
    """Rate of a layer of the thesis's network: a batch of 1,024 of 256 neurons."""
    batch, weights = (torch.rand(rows, 256).to(device, dtype) for rows in (1024, 256))
    return 1024 * 256**2 / 1e9 / _seconds(lambda: batch @ weights, device)


def _convolutions(device: torch.device, dtype: torch.dtype) -> float:
    """Rate of a convolution of 3 × 3 pixels, 32 channels to 32."""
    like = {"device": device, "dtype": dtype, "memory_format": torch.channels_last}
    image = torch.rand(1, 32, 64, 64).to(**like)
    layer = torch.nn.Conv2d(32, 32, 3, padding=1, bias=False).to(**like)
    with torch.inference_mode():
        return 64**2 * 9 * 32**2 / 1e9 / _seconds(lambda: layer(image), device)


def _rays() -> float:
    """Rate of rays from around a ball's surface, half of which hit it."""
    ball = trimesh.creation.icosphere(subdivisions=6)
    tracer = Tracer(ball.vertices.astype(np.float32), ball.faces.astype(np.int32))
    directions = np.random.default_rng(0).normal(size=(8192, 3)).astype(np.float32)
    origins = np.resize(ball.vertices, directions.shape).astype(np.float32) * np.float32(1.01)
    rays = _seconds(lambda: tracer.occluded(origins, directions), torch.device("cpu"))
    return len(directions) / 1e6 / rays


def _loops() -> float:
    """Rate of exponentials of 16,384 numbers, as filters compute them."""
    values = np.linspace(-1, 1, 1 << 14, dtype=np.float32)
    return len(values) / 1e6 / _seconds(lambda: np.exp(-values * values), torch.device("cpu"))


def _seconds(work: Callable[[], object], device: torch.device) -> float:
    """Least of repetitions."""
    work()
    least, deadline = np.inf, time.perf_counter() + SECONDS
    while time.perf_counter() < deadline:
        started = finished(device)
        work()
        least = min(least, finished(device) - started)
    return float(least)


def _start() -> float:
    """Processor seconds of a process, the second one: the first may compile its modules."""
    for _ in range(2):
        before = _children()
        subprocess.run([sys.executable, "-c", START], check=True)
    return _children() - before


def _children() -> float:
    """Processor seconds of the processes that this one has started."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime
