"""One thread for all libraries that compute, so that times of methods compare."""

from collections.abc import Iterator
from contextlib import contextmanager

from threadpoolctl import threadpool_limits


@contextmanager
def one_thread() -> Iterator[None]:
    """While it lasts PyTorch, OpenMP and BLAS compute on one thread, however many a job has.

    Snakemake tells them those of the rule. Of our own code, numba's and Embree's, nothing is parallel
    by itself; Open Image Denoise is given its number.
    """
    import torch  # here, so that stages without networks need not load it before they start

    before = torch.get_num_threads()
    torch.set_num_threads(1)
    try:
        with threadpool_limits(1):
            yield
    finally:
        torch.set_num_threads(before)
