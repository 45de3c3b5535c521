"""The stage that times a network of whole frames by level and part (Datta et al. 2022, S3)."""

import time
from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import torch

from neural_shadows.files.whole_files import write_json
from neural_shadows.frames.feature_names import channels_of
from neural_shadows.networks.compute import choose_device, is_native
from neural_shadows.networks.screen_space.screen_forms import layers_of
from neural_shadows.networks.screen_space.screen_network import ScreenNetwork
from neural_shadows.networks.screen_space.screen_networks import make_screen_network
from neural_shadows.networks.screen_space.widths import by_level
from neural_shadows.running.origin import describe_origin
from neural_shadows.running.progress import progress_bar
from neural_shadows.running.stage import run_stage

WARM_UP = 3
# A slow network is timed less often: the paper's original in float32 takes 5 s a frame on a core.
MOST_SECONDS, LEAST = 60, WARM_UP + 3
PRECISIONS = (torch.float32, torch.bfloat16)

Place = tuple[int, str]  # a level and a part of `ScreenNetwork.parts`


def profile_screen_network(
    profile_json: Path,
    *,
    network: Mapping[str, Any],
    profile: Mapping[str, int],
    device: str,
    threads: int,
) -> None:
    """Time a network's answer to one frame, untrained: its times do not depend on its weights.

    Frames, frames by part and matrix products take turns; of each the median counts. A number format
    that a device would emulate is not timed on it: bfloat16 takes 50 times as long with AVX2 alone.

    Args:
        profile_json: `levels`: `weights` (without biases), and for a pixel of the frame `macs` and
            `storage` of each; `runs`, in float32 and bfloat16 (see `is_native`), on one thread, on
            all, and on a GPU if there is one: `whole_ms`, `parts` (`level`, `part`, `ms`), and
            `product_macs`, multiply-adds a second of a product of square matrices.
        profile: `width`, `height` (pixels), `repeats`, and `product_size`, rows and columns of the
            matrices whose product is the rate to reach.

    Raises:
        InputError: `device` is cuda, and there is none.
    """
    chosen = choose_device(device)
    places = [(torch.device("cpu"), count) for count in sorted({1, threads})]
    places += [(chosen, threads)] * (chosen.type == "cuda")
    planned = [(*place, one) for place in places for one in PRECISIONS if is_native(one, place[0])]
    runs = []
    with progress_bar(len(planned), "runs", "profile") as bar:
        for place, count, precision in planned:
            torch.set_num_threads(count)
            timed = make_screen_network(network).for_inference()
            timed = timed.to(place, precision, memory_format=torch.channels_last)
            times = _timed(timed, profile)
            name = str(precision).removeprefix("torch.")
            runs.append({"device": place.type, "threads": count, "precision": name} | times)
            bar.update()
    write_json(
        profile_json,
        {
            "network": network,
            **profile,
            "warm_up": WARM_UP,
            "levels": _counts(network),
            "runs": runs,
            **describe_origin(),
        },
    )


def _counts(network: Mapping[str, Any]) -> list[dict[str, float]]:
    layers = layers_of(network)
    found = {name: by_level(layers, name) for name in ("weights", "macs", "storage")}
    levels = found["weights"]
    return [{"level": k} | {name: each[k] for name, each in found.items()} for k in levels]


def _timed(network: ScreenNetwork, profile: Mapping[str, int]) -> dict[str, Any]:
    weight = next(network.parameters())
    like = {"device": weight.device, "dtype": weight.dtype}
    channels = channels_of(network.features)
    generator = torch.Generator().manual_seed(0)
    size = 1, channels, profile["height"], profile["width"]
    x = torch.rand(size, generator=generator).to(**like, memory_format=torch.channels_last)
    side = profile["product_size"]
    square = torch.rand(side, side, generator=generator).to(**like)
    times: dict[str, list[float]] = defaultdict(list)
    parts: dict[Place, list[float]] = defaultdict(list)
    clock = _clock(weight.device)

    def take(name: str, work: Callable[[], Any]) -> None:
        started = clock()
        work()
        times[name].append(clock() - started)

    with torch.inference_mode():
        until = clock() + MOST_SECONDS
        for number in range(WARM_UP + profile["repeats"]):
            if number >= LEAST and clock() > until:
                break
            take("whole", lambda: network(x))
            take("product", lambda: square @ square)
            with _parts_timed(network, parts, clock):
                network(x)
    median = {name: float(np.median(each[WARM_UP:])) for name, each in (times | parts).items()}
    return {
        "whole_ms": 1000 * median["whole"],
        "product_macs": side**3 / median["product"],
        "parts": [
            {"level": place[0], "part": place[1], "ms": 1000 * median[place]} for place in parts
        ],
    }


@contextmanager
def _parts_timed(
    network: ScreenNetwork, found: dict[Place, list[float]], clock: Callable[[], float]
) -> Iterator[None]:
    """While it lasts, seconds of each part are added to `found`."""
    started: dict[Place, float] = {}
    hooks = []
    for place, part in network.parts().items():

        def begin(*_, place=place) -> None:
            started[place] = clock()

        def end(*_, place=place) -> None:
            found[place].append(clock() - started[place])

        hooks += [part.register_forward_pre_hook(begin), part.register_forward_hook(end)]
    try:
        yield
    finally:
        for hook in hooks:
            hook.remove()


def _clock(device: torch.device) -> Callable[[], float]:
    """Seconds, when all work that was asked for is done."""

    def now() -> float:
        if device.type == "cuda":
            torch.cuda.synchronize(device)
        return time.perf_counter()

    return now


if "snakemake" in globals():
    run_stage(snakemake, profile_screen_network)
