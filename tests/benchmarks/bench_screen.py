"""Screen-space networks on frames of 2048 × 1024: in bands of rows, layer by layer, by part.

In bfloat16 where the CPU has it, or float32. The ceiling is a product of square matrices of the
same type, on as many threads, by the multiply-adds of the network.
"""

import torch
from measurement import Row, median_seconds, name_of, torch_threads

from neural_shadows.frames.feature_names import channels_of
from neural_shadows.networks.compute import choose_dtype
from neural_shadows.networks.screen_space.screen_forms import layers_of
from neural_shadows.networks.screen_space.screen_networks import make_screen_network
from neural_shadows.networks.screen_space.widths import total
from neural_shadows.networks.settings.networks import screen_network

WIDTH, HEIGHT = 2048, 1024
KERNELS = {
    "form": "kernels",
    "features": ["cosine", "c_v_by_d", "z_f", "penumbra", "behind", "z_b_by_z", "z_b", "base_msm"],
    "filters": 4,
}
NETWORKS = {
    "NSM, fast form": {
        "form": "shuffle",
        "widths": [32, 64, 128, 256],
        "features": ["c_e", "view", "ratio", "difference"],
    },
    "KPNSM": KERNELS | {"widths": [64, 64, 128, 256]},
    "KPNSM, slim": KERNELS | {"widths": [32, 32, 64, 128]},
}
PRODUCT = 2048  # rows and columns of the matrices
THREADS = (1, 2)


def rows(quick: bool) -> list[Row]:
    """Frames a second on one thread and on two."""
    return [row for name in NETWORKS for row in _rows(name, 2 if quick else 7)]


def _rows(name: str, rounds: int) -> list[Row]:
    settings = screen_network(NETWORKS[name])
    dtype = choose_dtype("auto", torch.device("cpu"))
    network = make_screen_network(settings).for_inference().in_format(dtype)
    frame = torch.rand(1, channels_of(settings.features), HEIGHT, WIDTH)
    frame = frame.contiguous(memory_format=torch.channels_last)
    macs = total(layers_of(settings), "macs") * WIDTH * HEIGHT
    square = torch.rand(PRODUCT, PRODUCT).to(dtype)
    works = {
        "frame": lambda: network.in_bands(frame),
        "layer by layer": lambda: network(frame),
        "product": lambda: square @ square,
    }
    result = []
    with torch.inference_mode():
        if settings.form == "kernels":
            inner, base = network.inner(frame), frame[:, -1:]
            logits = network.head(inner)
            works |= {
                "U-Net": lambda: network.inner(frame),
                "last convolution": lambda: network.head(inner),
                "filter": lambda: network.exit(logits, base),
            }
        for threads in THREADS:
            with torch_threads(threads):
                seconds = median_seconds(works, rounds)
            ceiling = PRODUCT**3 / seconds.pop("product") / macs
            for part, value in seconds.items():
                stage = f"{name}, {WIDTH} x {HEIGHT}, {name_of(dtype)}: {part}"
                most = ceiling if part in ("frame", "layer by layer") else None
                result.append(Row(stage, f"cpu x{threads}", 1 / value, "frames/s", most))
    return result
