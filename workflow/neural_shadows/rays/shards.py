"""How the stages go through a shard: a tracer, a file, tasks in threads."""

import os
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from neural_shadows.files.whole_files import whole_file
from neural_shadows.meshes.prepared_mesh import read_prepared
from neural_shadows.running.progress import progress_bar
from neural_shadows.scenes.tracing import Tracer

# Rays that one task of a thread traces at least: below that, starting the task shows.
_TASK_RAYS = 8192


def run_tasks(
    task: Callable[[int, int], None], directions: int, points: int, threads: int, title: str
) -> None:
    """Run task(begin, end) over consecutive ranges of directions in threads, with a bar.

    Embree and the numba kernels release the interpreter's lock, so that threads scale.
    """
    step = -(-_TASK_RAYS // points)
    begins = range(0, directions, step)
    ends = [min(begin + step, directions) for begin in begins]
    with (
        progress_bar(directions * points, "samples", title) as bar,
        ThreadPoolExecutor(threads) as pool,
    ):
        for begin, end, _ in zip(begins, ends, pool.map(task, begins, ends), strict=True):
            bar.update((end - begin) * points)


def open_tracer(mesh_ply: Path) -> Tracer:
    """A tracer of a prepared mesh."""
    mesh = read_prepared(mesh_ply)
    return Tracer(mesh.vertices, mesh.faces)


@contextmanager
def new_shard(path: Path, shape: tuple[int, ...]) -> Iterator[np.ndarray]:
    """A new float32 `.npy` file, memory-mapped, for it may be larger than memory; whole or not."""
    with whole_file(path) as part:
        array = np.lib.format.open_memmap(part, mode="w+", dtype=np.float32, shape=shape)
        if hasattr(os, "posix_fallocate"):
            # A full disk is an error here; found when a page is written, it kills the process.
            with part.open("rb+") as file:
                os.posix_fallocate(file.fileno(), 0, part.stat().st_size)
        yield array
        array.flush()
