"""Formats of mesh files by suffix."""

from pathlib import Path

from neural_shadows.errors import InputError

FORMATS = ("ply", "obj", "stl", "glb")


def format_of(path: str | Path) -> str:
    """Format of a mesh file by its suffix, possibly before `.gz`.

    Raises:
        InputError: the suffix is not in `FORMATS`.
    """
    kind = Path(Path(path).name.lower().removesuffix(".gz")).suffix.removeprefix(".")
    if kind not in FORMATS:
        allowed = ", ".join(f".{suffix}" for suffix in FORMATS)
        raise InputError(
            f"mesh {path}: unknown suffix. Give one of {allowed} (also followed by .gz)"
        )
    return kind
