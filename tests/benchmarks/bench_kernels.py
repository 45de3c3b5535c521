"""Kernel Predicting Neural Shadow Maps: the filter beside `unfold`, and whole frames by part.

Memory is what a process of its own holds at most more than before, with inputs made and both ways
warm: run as a script with the name of a way, it prints its MiB. The ceiling of frames is a product of
square matrices of the same type, on as many threads, by the multiply-adds of the network: in
bfloat16 where the CPU has it, or float32.
"""

import subprocess
import sys
from functools import partial

import torch
from measurement import Row, median_seconds
from torch import Tensor
from unfolded import by_unfold

from neural_shadows.networks.compute import choose_dtype
from neural_shadows.networks.screen_space.kernel_unet import KernelUnet
from neural_shadows.networks.screen_space.kernel_widths import kernel_convolutions
from neural_shadows.networks.screen_space.pixel_kernels import filtered
from neural_shadows.networks.screen_space.widths import total
from neural_shadows.running.process_memory import held_bytes, peak_bytes

WAYS = {"ours": filtered, "unfold": by_unfold}
FEATURES = ["cosine", "c_v_by_d", "z_f", "penumbra", "behind", "z_b_by_z", "z_b", "base_msm"]
WIDTHS, FILTERS = [64, 64, 128, 256], 4
PRODUCT = 2048  # rows and columns of the matrices
THREADS = (1, 2)


def rows(quick: bool) -> list[Row]:
    """The filter forward and backward on one thread; frames a second on one thread and on two."""
    kept = torch.get_num_threads()
    try:
        torch.set_num_threads(1)
        return [*_filter(3 if quick else 10), *_frames(2 if quick else 7)]
    finally:
        torch.set_num_threads(kept)


def _filter(rounds: int) -> list[Row]:
    found, name = [], "filter of 512 x 256 by 4 kernels, forward and backward"
    for factor in (1, 2):
        made = _inputs(256, 512, factor)
        works = {way: partial(_there_and_back, work, *made) for way, work in WAYS.items()}
        rate = {way: 1 / one for way, one in median_seconds(works, rounds).items()}
        peer = {"peer": "unfold", "peer_rate": rate["unfold"]}
        stage = f"{name}, logits at 1/{factor} of the sides"
        found.append(Row(stage, "cpu x1", rate["ours"], "frames/s", **peer))
    mebibytes = {way: _asked(way) for way in WAYS}
    peer = {"peer": "unfold", "peer_rate": mebibytes["unfold"]}
    return [*found, Row(f"{stage}: memory", "cpu x1", mebibytes["ours"], "MiB", **peer)]


def _inputs(height: int, width: int, factor: int) -> tuple[Tensor, Tensor, int]:
    logits = torch.randn(1, 25 * FILTERS, height // factor, width // factor)
    return logits.requires_grad_(), torch.rand(1, 1, height, width, requires_grad=True), factor


def _there_and_back(work, logits: Tensor, base: Tensor, factor: int) -> None:
    torch.autograd.grad(work(logits, base, factor).sum(), (logits, base))


def _asked(way: str) -> float:
    return float(subprocess.check_output([sys.executable, __file__, way], text=True))


def _mebibytes(way: str) -> float:
    """Of which our own are those of the gradient of the logits, too."""
    torch.set_num_threads(1)
    _there_and_back(WAYS[way], *_inputs(16, 16, 2))
    made = _inputs(256, 512, 2)
    before = held_bytes()
    _there_and_back(WAYS[way], *made)
    return (peak_bytes() - before) / 2**20


def _frames(rounds: int) -> list[Row]:
    dtype = choose_dtype("auto", torch.device("cpu"))
    network = KernelUnet("kernels", WIDTHS, FEATURES, FILTERS).for_inference().in_format(dtype)
    frame = torch.rand(1, len(FEATURES), 1024, 2048).contiguous(memory_format=torch.channels_last)
    macs = total(kernel_convolutions("kernels", WIDTHS, len(FEATURES), FILTERS), "macs")
    macs *= frame[0, 0].numel()
    square = torch.rand(PRODUCT, PRODUCT).to(dtype)
    found = []
    with torch.inference_mode():
        inner, base = network.inner(frame), frame[:, -1:]
        logits = network.head(inner)
        works = {
            "frame": lambda: network(frame),
            "U-Net": lambda: network.inner(frame),
            "last convolution": lambda: network.head(inner),
            "filter": lambda: network.exit(logits, base),
            "product": lambda: square @ square,
        }
        for threads in THREADS:
            torch.set_num_threads(threads)
            seconds = median_seconds(works, rounds)
            ceiling = PRODUCT**3 / seconds.pop("product") / macs
            for part, one in seconds.items():
                told = {"ceiling": ceiling} if part == "frame" else {}
                name = f"KPNSM, 2048 x 1024, {str(dtype).removeprefix('torch.')}: {part}"
                found.append(Row(name, f"cpu x{threads}", 1 / one, "frames/s", **told))
    return found


if __name__ == "__main__":
    print(_mebibytes(sys.argv[1]))
