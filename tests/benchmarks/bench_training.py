"""Training rate of the thesis's network on this CPU, beside the plain step and the ceiling.

    python tests/benchmarks/bench_training.py [--width 256] [--batch 1024] [--rounds 7]

Per round, one after another so that all see the same machine: our step in the number format that
`precision: auto` chooses, cache-sized chunks side by side; the plain step, float32 on the whole
batch at once, threads within each product; and the rate that the layers' matrix products alone would allow (the ceiling). Prints
medians over the rounds, and ratios.
"""

import argparse
import time
from concurrent.futures import Executor

import numpy as np
import torch

from neural_shadows.compute import choose_dtype
from neural_shadows.dead_zone_loss import DeadZone
from neural_shadows.frequency_network import FrequencyNetwork
from neural_shadows.hardware import describe_machine
from neural_shadows.shadow_network import TRAINING_CHUNK
from neural_shadows.training import TrainingRun, chunk_size, gradient_pool

DESK_BATCH = 1024


class RandomRays:
    """Rays across the unit sphere with made-up bounds: the rate does not depend on them."""

    count = 65536

    def __init__(self):
        generator = np.random.default_rng(0)

        def unit():
            vectors = generator.normal(size=(self.count, 3)).astype(np.float32)
            return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)

        self.origins, self.directions = unit(), unit()
        self.t_lb = generator.random(self.count, dtype=np.float32)
        self.t_ub = self.t_lb + np.float32(0.1)

    def gather(self, indices):
        return tuple(
            part[indices] for part in (self.origins, self.directions, self.t_lb, self.t_ub)
        )


def product_seconds(network: FrequencyNetwork, dtype: torch.dtype, batch: int) -> float:
    """Seconds of one batch's matrix products: forward, and both of the backward pass."""
    pairs = []
    rows = min(batch, 4096)  # 2 MiB of activations, where the products were fastest
    for weight in network.layers:
        x = torch.randn(rows, weight.shape[1]).to(dtype)
        y = torch.randn(rows, weight.shape[0]).to(dtype)
        pairs.append((x, y, weight.detach().to(dtype)))
    started = time.perf_counter()
    for _ in range(batch // rows):
        for i, (x, y, weight) in enumerate(pairs):
            torch.mm(x, weight.t())
            torch.mm(y.t(), x)
            if i:  # nobody needs the gradient of the encoding
                torch.mm(y, weight)
    return time.perf_counter() - started


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--width", type=int, default=256)
    parser.add_argument("--batch", type=int, default=DESK_BATCH, help="the default: desk's")
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--threads", type=int, default=2)
    arguments = parser.parse_args()
    dtype = choose_dtype("auto", torch.device("cpu"))
    rays = RandomRays()
    network = FrequencyNetwork(frequencies=10, width=arguments.width, hidden_layers=8)
    network.initialise(0)
    run = TrainingRun(network, torch.device("cpu"), DeadZone(), 0)

    pool = gradient_pool(arguments.threads)
    serial = gradient_pool(1)
    serial.submit(torch.set_num_threads, arguments.threads).result()

    def step_seconds(step_dtype: torch.dtype, chunk: int, workers: Executor, number: int) -> float:
        indices = np.random.default_rng(number).integers(0, rays.count, arguments.batch)
        started = time.perf_counter()
        run.train_step(rays, indices, 1e-4, step_dtype, chunk, workers)
        return time.perf_counter() - started

    ours = dtype, chunk_size(arguments.batch, torch.device("cpu"), TRAINING_CHUNK), pool
    plain = torch.float32, arguments.batch, serial
    seconds: dict[str, list[float]] = {"ours": [], "plain": [], "ceiling": []}
    for number in range(arguments.rounds + 1):  # the first round warms up
        torch.set_num_threads(1)
        seconds["ours"].append(step_seconds(*ours, number))
        torch.set_num_threads(arguments.threads)
        seconds["plain"].append(step_seconds(*plain, number))
        seconds["ceiling"].append(product_seconds(network, dtype, arguments.batch))
    rate = {name: arguments.batch / np.median(times[1:]) for name, times in seconds.items()}
    print(f"{describe_machine()}, {arguments.threads} threads, median of {arguments.rounds} rounds")
    print(
        f"width {arguments.width}, {str(dtype).removeprefix('torch.')}: {rate['ours']:,.0f} samples/s"
    )
    print(f"plain float32 step, whole batch: {rate['plain']:,.0f} samples/s")
    print(f"matrix products alone: {rate['ceiling']:,.0f} samples/s")
    print(f"ratio to the plain step: {rate['ours'] / rate['plain']:.1f}")
    print(f"share of the matrix products' rate: {rate['ours'] / rate['ceiling']:.0%}")


if __name__ == "__main__":
    main()
