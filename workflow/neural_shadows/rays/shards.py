"""Processing of a shard: a tracer, tasks in threads."""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from neural_shadows.meshes.prepared_mesh import read_prepared
from neural_shadows.running.progress import progress_bar
from neural_shadows.scenes.tracing import Tracer

# Least rays of a task: with fewer, starting it takes noticeable time.
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
    """Open a tracer of a prepared mesh."""
    mesh = read_prepared(mesh_ply)
    return Tracer(mesh.vertices, mesh.faces)
