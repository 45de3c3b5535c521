"""C compiled at first use, cached beside Numba's files."""

import ctypes
import hashlib
import os
import shutil
import subprocess
import tempfile
import warnings
from functools import cache
from pathlib import Path

from llvmlite import binding

# No product is contracted with a sum: results equal those without C to the bit.
FLAGS = (
    "-O3", "-march=native", "-ffp-contract=off", "-fno-math-errno", "-fno-trapping-math",
    "-fwrapv", "-DNDEBUG", "-shared", "-fPIC",
)  # fmt: skip


@cache
def compiled_c(source: Path) -> ctypes.CDLL | None:
    """Load a C file's functions; None, with one warning, where it cannot be compiled.

    Compiled for this processor by gcc or cc, once for each machine.
    """
    compiler = shutil.which("gcc") or shutil.which("cc")
    if compiler is None:
        return _without(source, "no gcc or cc")
    processor = binding.get_host_cpu_name() + binding.get_host_cpu_features().flatten()
    key = hashlib.sha256(source.read_bytes() + repr((compiler, FLAGS, processor)).encode())
    for folder in _folders(source):
        path = folder / f"{source.stem}.{key.hexdigest()[:16]}.so"
        try:
            if not path.exists():
                folder.mkdir(parents=True, exist_ok=True)
                _compile(compiler, source, path)
            return ctypes.CDLL(str(path))
        except subprocess.CalledProcessError as error:
            return _without(source, (error.stderr.strip().splitlines() or [error])[-1])
        except OSError as error:  # read-only, full, or not executable
            reason = error
    return _without(source, reason)


def _folders(source: Path) -> list[Path]:
    """Where compiled files may lie, in Numba's order."""
    named = os.environ.get("NUMBA_CACHE_DIR")
    caches = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    return [Path(named)] if named else [source.parent / "__pycache__", caches / "neural_shadows"]


def _compile(compiler: str, source: Path, path: Path) -> None:
    """Compile to a file that is whole or absent."""
    with tempfile.TemporaryDirectory(dir=path.parent) as folder:
        part = Path(folder) / path.name
        subprocess.run(
            [compiler, *FLAGS, str(source), "-o", str(part), "-lm"],
            check=True, capture_output=True, text=True,
        )  # fmt: skip
        os.replace(part, path)


def _without(source: Path, reason: object) -> None:
    warnings.warn(
        f"{source.name}: not compiled: {reason}. The same runs in Numba, about 1.5 times as long. "
        "Install gcc for the faster form.",
        RuntimeWarning,
        stacklevel=3,
    )
