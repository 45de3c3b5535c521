"""Cores of a run that no job has: each job tells its own in a file that its process locks."""

import fcntl
import os
from pathlib import Path

# Of the working folder, beside Snakemake's own state.
FOLDER = Path(".snakemake/cores")


class JobCores:
    """The cores that a job has, told to the run's other jobs.

    A process that ends in any way, a kill included, loses its lock and is no longer counted.

    Args:
        count: as Snakemake counts them.
    """

    def __init__(self, count: int):
        self.count = count
        FOLDER.mkdir(parents=True, exist_ok=True)
        self.path = FOLDER / str(os.getpid())
        while not self._open():
            pass
        self._tell(count)

    def _open(self) -> bool:
        """Open and lock the file, unless another job just then takes it for an ended one's."""
        self.file = os.open(self.path, os.O_RDWR | os.O_CREAT | os.O_TRUNC)
        self.locks = again = False
        try:
            fcntl.flock(self.file, fcntl.LOCK_SH | fcntl.LOCK_NB)
            self.locks, again = True, os.fstat(self.file).st_nlink == 0
        except BlockingIOError:
            again = True
        except OSError:  # a file system without locks, as Lustre often is
            pass
        if again:
            os.close(self.file)
        return not again

    def take_idle(self, run_cores: int, most: int) -> int:
        """Take those of a run's cores that no other job has; return how many the job has now.

        At least its own: a job that starts meanwhile has its cores back after the next call.
        """
        if not self.locks:
            return self.count
        others = sum(_told(path) for path in FOLDER.iterdir() if path != self.path)
        taken = max(self.count, min(most, run_cores - others))
        self._tell(taken)
        return taken

    def _tell(self, count: int) -> None:
        os.pwrite(self.file, f"{count:<8}".encode(), 0)


def _told(path: Path) -> int:
    """Cores that a job has; 0, and its file removed, if it has ended."""
    try:
        with path.open("rb+") as file:
            try:
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                return int(file.read() or 0)
            path.unlink()
    except FileNotFoundError:  # removed by another job since
        pass
    return 0


JOB: JobCores | None = None
"""Of the running job; None outside of one."""
