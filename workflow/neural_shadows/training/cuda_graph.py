"""A training step as a CUDA graph: many kernels, one call."""

from collections.abc import Callable

import torch

# Steps before the recording, for libraries to choose kernels and reserve memory.
WARM_UP = 3


def recorded(step: Callable[[], None]) -> Callable[[], None]:
    """Wrap `step` for replay from a recording after `WARM_UP` calls.

    Args:
        step: changes tensors on a GPU in place, in constant shapes, and reads none back.
    """
    calls = 0
    recording: torch.cuda.CUDAGraph | None = None

    def advance() -> None:
        nonlocal calls, recording
        calls += 1
        if calls <= WARM_UP:
            on_side_stream(step)
            return
        if recording is None:
            recording = capture(step)
        recording.replay()

    return advance


def on_side_stream(step: Callable[[], None]) -> None:
    """Do a step in a side stream, required before recording."""
    stream = torch.cuda.Stream()
    stream.wait_stream(torch.cuda.current_stream())
    with torch.cuda.stream(stream):
        step()
    torch.cuda.current_stream().wait_stream(stream)


def capture(step: Callable[[], None]) -> torch.cuda.CUDAGraph:
    """Record a step without doing it."""
    graph = torch.cuda.CUDAGraph()
    with torch.cuda.graph(graph):
        step()
    return graph
