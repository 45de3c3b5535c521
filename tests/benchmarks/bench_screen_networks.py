"""Networks of whole frames: Neural Shadow Mapping's fast form on 2048 × 1024 pixels.

In bfloat16 where the CPU has it, or float32. The ceiling is a product of square matrices of the
same type, on as many threads.
"""

import torch
from measurement import Row, median_seconds

from neural_shadows.networks.compute import choose_dtype
from neural_shadows.networks.screen_space.screen_networks import make_screen_network
from neural_shadows.networks.screen_space.widths import convolutions, total

WIDTH, HEIGHT = 2048, 1024
NETWORK = {
    "form": "shuffle",
    "widths": [32, 64, 128, 256],
    "features": ["c_e", "view", "ratio", "difference"],
}
PRODUCT = 2048  # rows and columns of the matrices
THREADS = (1, 2)


def rows(quick: bool) -> list[Row]:
    """Frames a second on one thread and on two."""
    kept = torch.get_num_threads()
    try:
        return [_row(threads, 2 if quick else 10) for threads in THREADS]
    finally:
        torch.set_num_threads(kept)


def _row(threads: int, rounds: int) -> Row:
    torch.set_num_threads(threads)
    dtype = choose_dtype("auto", torch.device("cpu"))
    network = make_screen_network(NETWORK).to(dtype, memory_format=torch.channels_last)
    frame = torch.rand(1, 4, HEIGHT, WIDTH).to(dtype, memory_format=torch.channels_last)
    square = torch.rand(PRODUCT, PRODUCT).to(dtype)
    with torch.inference_mode():
        works = {"frame": lambda: network(frame), "product": lambda: square @ square}
        seconds = median_seconds(works, rounds)
    layers = convolutions(NETWORK["form"], NETWORK["widths"], 4)
    macs = total(layers, "macs") * WIDTH * HEIGHT
    ceiling = PRODUCT**3 / seconds["product"] / macs
    name = f"NSM, fast form, {WIDTH} x {HEIGHT}, {str(dtype).removeprefix('torch.')}"
    return Row(name, f"cpu x{threads}", 1 / seconds["frame"], "frames/s", ceiling=ceiling)
