"""Results of earlier jobs that turn out not to be whole."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from neural_shadows.errors import InputError


@contextmanager
def reading(path: str | Path, kind: str, *damages: type[Exception]) -> Iterator[None]:
    """Within this block a result of an earlier job is read.

    Args:
        path: the result.
        kind: what it should be, as `loss curve`.
        damages: the errors, besides ValueError, by which its content turns out not to be whole.

    Raises:
        InputError: the file is missing, or cannot be read, which need not be its fault; or it is
            not whole, and moved aside.
    """
    try:
        yield
    except FileNotFoundError as error:
        raise InputError(f"{path}: no such file; run the stage that makes it") from error
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror or error})") from error
    except (ValueError, *damages) as error:
        reason = " ".join(str(error).split())[:200] or type(error).__name__
        raise broken(path, f"not a whole {kind} ({reason})") from error


def broken(path: str | Path, reason: str) -> InputError:
    """Move a result aside, so that the next run makes it again, and give the error to raise.

    Args:
        path: what an earlier job wrote; it becomes `<path>.broken`, for whoever wants to look.
        reason: what is wrong with it, to follow its name.
    """
    path = Path(path)
    try:
        path.replace(f"{path}.broken")
    except OSError:  # a folder that cannot be written
        return InputError(f"{path}: {reason}: delete it and run again")
    return InputError(f"{path}: {reason}: moved to {path.name}.broken, run again to make it anew")
