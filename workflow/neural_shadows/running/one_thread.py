"""Single-threaded libraries, for comparable times."""

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager

from threadpoolctl import threadpool_limits


@contextmanager
def one_thread() -> Iterator[None]:
    """Limit PyTorch, OpenMP and BLAS to one thread, also where they are first loaded within.

    Snakemake sets the rule's number otherwise. Our numba and Embree code is single-threaded by itself;
    Open Image Denoise takes its number as a parameter.
    """
    # PyTorch takes seconds to load, needless for methods without networks.
    torch = sys.modules.get("torch")
    before = torch and torch.get_num_threads()
    variable = os.environ.get("OMP_NUM_THREADS")
    os.environ["OMP_NUM_THREADS"] = "1"
    if torch:
        torch.set_num_threads(1)
    try:
        with threadpool_limits(1):
            yield
    finally:
        if variable is None:
            del os.environ["OMP_NUM_THREADS"]
        else:
            os.environ["OMP_NUM_THREADS"] = variable
        if torch:
            torch.set_num_threads(before)
