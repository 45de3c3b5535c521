"""Results of earlier jobs that turn out not to be whole."""

from pathlib import Path

from neural_shadows.errors import InputError


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
