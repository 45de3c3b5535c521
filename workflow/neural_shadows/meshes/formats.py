"""The formats of mesh files, by their names' ends."""

from pathlib import Path

from neural_shadows.errors import InputError

FORMATS = ("ply", "obj", "stl", "glb")


def format_of(path: str | Path) -> str:
    """Which of `FORMATS` a mesh file has by its name, which may end in `.gz` too.

    Raises:
        InputError: none of them.
    """
    kind = Path(Path(path).name.lower().removesuffix(".gz")).suffix.removeprefix(".")
    if kind not in FORMATS:
        allowed = ", ".join(f".{suffix}" for suffix in FORMATS)
        raise InputError(
            f"mesh {path}: the format is not known by this suffix; "
            f"give one of {allowed} (also with .gz behind it)"
        )
    return kind
