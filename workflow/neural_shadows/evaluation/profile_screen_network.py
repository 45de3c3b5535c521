"""Stage: times of a screen-space network by level and part. As in Datta et al. 2022, S3."""

from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import torch

from neural_shadows.files.whole_files import write_json
from neural_shadows.frames.feature_names import channels_of
from neural_shadows.networks.compute import choose_device, finished, is_native
from neural_shadows.networks.screen_space.screen_forms import layers_of
from neural_shadows.networks.screen_space.screen_network import ScreenNetwork
from neural_shadows.networks.screen_space.screen_networks import make_screen_network
from neural_shadows.networks.screen_space.widths import by_level
from neural_shadows.networks.settings.networks import ScreenNetwork as Settings
from neural_shadows.running.origin import describe_origin
from neural_shadows.running.progress import progress_bar
from neural_shadows.running.stage import run_stage

WARM_UP = 3
# A slow network is timed less often: the paper's original in float32 takes 5 s a frame on a core.
MOST_SECONDS, LEAST = 60, WARM_UP + 3
PRECISIONS = (torch.float32, torch.bfloat16)

LevelPart = tuple[int, str]  # a level and a part of `ScreenNetwork.parts`


def profile_screen_network(
    profile_json: Path,
    *,
    network: Settings,
    profile: Mapping[str, int],
    device: str,
    threads: int,
    formats: Sequence[str] | None = None,
) -> None:
    """Time an untrained network on one frame. Its times do not depend on its weights, while logits of
    kernels are small (see `half_kernel_loops`), as those of trained networks were.

    Frames, frames by part and matrix products take turns; of each the median counts. Whole frames
    are evaluated in bands of rows, as methods do; parts one after another. A number format
    that a device would emulate is not timed on it: bfloat16 takes 50 times as long with AVX2 alone.

    Args:
        profile_json: `levels`: `weights` (without biases), and for a pixel of the frame `macs` and
            `storage` of each; `runs`, in float32 and bfloat16 (see `is_native`), on one thread, on
            `threads`, and on a GPU if there is one: `whole_ms`, `parts` (`level`, `part`, `ms`), and
            `product_macs`, multiply-adds a second of a product of square matrices.
        formats: time whole frames in these alone, on `threads` or the GPU; in float32 where that has none.
        profile: `width`, `height` (pixels), `repeats`, and `product_size`, rows and columns of the
            matrices whose product is the rate to reach.

    Raises:
        InputError: `device` is cuda, and there is none.
    """
    chosen = choose_device(device)
    devices = [(torch.device("cpu"), count) for count in sorted({1, threads})]
    devices += [(chosen, threads)] * (chosen.type == "cuda")
    if formats:
        devices = devices[-1:]
    asked = [dtype for dtype in PRECISIONS if not formats or _name(dtype) in formats]
    planned = [(*on, dtype) for on in devices for dtype in asked if is_native(dtype, on[0])]
    runs = []
    with progress_bar(len(planned), "runs", "profile") as bar:
        for on, count, precision in planned or [(*devices[-1], torch.float32)]:
            torch.set_num_threads(count)
            timed = make_screen_network(network).for_inference()
            timed = timed.to(on, precision, memory_format=torch.channels_last)
            times = _timed(timed, profile, by_part=not formats)
            run = {"device": on.type, "threads": count, "precision": _name(precision)}
            runs.append(run | times)
            bar.update()
    write_json(
        profile_json,
        {
            "network": network.model_dump(),
            **profile,
            "warm_up": WARM_UP,
            "formats": [*map(_name, asked)],
            "levels": _counts(network),
            "runs": runs,
            **describe_origin(),
        },
    )


def _counts(network: Settings) -> list[dict[str, float]]:
    layers = layers_of(network)
    counts = {name: by_level(layers, name) for name in ("weights", "macs", "storage")}
    levels = counts["weights"]
    return [{"level": k} | {name: each[k] for name, each in counts.items()} for k in levels]


def _name(dtype: torch.dtype) -> str:
    return str(dtype).removeprefix("torch.")


def _timed(network: ScreenNetwork, profile: Mapping[str, int], *, by_part: bool) -> dict[str, Any]:
    weight = next(network.parameters())
    like = {"device": weight.device, "dtype": weight.dtype}
    channels = channels_of(network.features)
    generator = torch.Generator().manual_seed(0)
    size = 1, channels, profile["height"], profile["width"]
    x = torch.rand(size, generator=generator).to(**like, memory_format=torch.channels_last)
    side = profile["product_size"]
    square = torch.rand(side, side, generator=generator).to(**like)
    times: dict[str, list[float]] = defaultdict(list)
    parts: dict[LevelPart, list[float]] = defaultdict(list)
    clock = partial(finished, weight.device)

    def measure(name: str, work: Callable[[], Any]) -> None:
        started = clock()
        work()
        times[name].append(clock() - started)

    with torch.inference_mode():
        deadline = clock() + MOST_SECONDS
        for number in range(WARM_UP + profile["repeats"]):
            if number >= LEAST and clock() > deadline:
                break
            measure("whole", lambda: network.in_bands(x))
            measure("product", lambda: square @ square)
            if by_part:
                with _parts_timed(network, parts, clock):
                    network(x)
    median = {name: float(np.median(each[WARM_UP:])) for name, each in (times | parts).items()}
    return {
        "whole_ms": 1000 * median["whole"],
        "product_macs": side**3 / median["product"],
        "parts": [
            {"level": level, "part": part, "ms": 1000 * median[level, part]}
            for level, part in parts
        ],
    }


@contextmanager
def _parts_timed(
    network: ScreenNetwork, times: dict[LevelPart, list[float]], clock: Callable[[], float]
) -> Iterator[None]:
    """Append seconds of each part to `times` in its context."""
    started: dict[LevelPart, float] = {}
    hooks = []
    for level_part, part in network.parts().items():

        def begin(*_, level_part=level_part) -> None:
            started[level_part] = clock()

        def end(*_, level_part=level_part) -> None:
            times[level_part].append(clock() - started[level_part])

        hooks += [part.register_forward_pre_hook(begin), part.register_forward_hook(end)]
    try:
        yield
    finally:
        for hook in hooks:
            hook.remove()


if "snakemake" in globals():
    run_stage(snakemake, profile_screen_network)
