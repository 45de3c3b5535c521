"""The folder of compiled kernels."""

from pathlib import Path

from neural_shadows.running.module_graph import PACKAGE, digest, modules_of

VARIABLE = "NUMBA_CACHE_DIR"  # set before Numba is imported


def kernel_cache(folder: Path) -> Path:
    """Folder, in another one, of compiled kernels of Numba and C.

    Numba caches kernels by the age of their own file: a kernel that calls one of another, edited
    module would be stale. The folder is therefore named by the content of kernels' modules and of all
    that these import, as this process has read them first. Of the whole package, an edited plot would
    compile all anew.
    """
    compiled = (path for path in PACKAGE.glob("**/*.py") if b"import njit" in path.read_bytes())
    code = digest({module for path in compiled for module in modules_of(path)})
    return folder.absolute() / "numba" / code
