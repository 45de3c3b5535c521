"""Single-threaded libraries, for comparable times."""

from collections.abc import Iterator
from contextlib import contextmanager

from threadpoolctl import threadpool_limits


@contextmanager
def one_thread() -> Iterator[None]:
    """Limit PyTorch, OpenMP and BLAS to one thread.

    Snakemake sets the rule's number otherwise. Our numba and Embree code is single-threaded by itself;
    Open Image Denoise takes its number as a parameter.
    """
    import torch  # loading it takes seconds, needless in stages without networks

    before = torch.get_num_threads()
    torch.set_num_threads(1)
    try:
        with threadpool_limits(1):
            yield
    finally:
        torch.set_num_threads(before)
