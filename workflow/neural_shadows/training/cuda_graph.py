"""A training step as a CUDA graph: hundreds of small kernels started by one call."""

from collections.abc import Callable

import torch

# Steps before the recording, in which libraries choose their kernels and reserve their memory.
WARM_UP = 3


def recorded(step: Callable[[], None]) -> Callable[[], None]:
    """`step` that is done as it is `WARM_UP` times, and then replayed from a recording.

    Args:
        step: changes tensors on a GPU in place, in shapes that never differ, and reads none
            of them back.
    """
    calls = 0
    recording: torch.cuda.CUDAGraph | None = None

    def advance() -> None:
        nonlocal calls, recording
        calls += 1
        if calls <= WARM_UP:
            aside(step)
            return
        if recording is None:
            recording = capture(step)
        recording.replay()

    return advance


def aside(step: Callable[[], None]) -> None:
    """Do a step in a stream of its own, as is asked of those before a recording."""
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
