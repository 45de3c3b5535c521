"""A field in one file: safetensors, with a version in its header.

Arrays are those of a `ShadowField` as they lie in memory, so that a program in any language reads
them without a decoder: `centre` (3,) and `radius` (1,) float64, `grid` (B, B, B) uint8 of
`grid_codes`, `bricks` (n, 125) int8, and of a sheet `cells` (n,) uint64.
"""

from pathlib import Path

import numpy as np
from safetensors import SafetensorError, safe_open
from safetensors.numpy import save

from neural_shadows.errors import InputError
from neural_shadows.files.whole_files import whole_file
from neural_shadows.representations.distance_bricks.field_marching import BRICK_VERTICES
from neural_shadows.representations.shadow_field.grid_codes import HELD, grid_codes, grid_of

FORMAT, VERSION = "neural_shadows.ShadowField", "1"  # one text: safetensors orders texts at random
_DTYPES = {"centre": "<f8", "radius": "<f8", "grid": "u1", "bricks": "i1", "cells": "<u8"}


def write_field(path: str | Path, arrays: dict[str, np.ndarray]) -> None:
    """Write a field's arrays, whole or not at all.

    Args:
        arrays: `centre`, `radius`, `grid` (see `BrickLayout`), `bricks` and `cells`, empty of a
            solid.
    """
    stored = {**arrays, "radius": np.array([arrays["radius"]]), "grid": grid_codes(arrays["grid"])}
    if not len(stored["cells"]):
        del stored["cells"]
    stored = {name: np.ascontiguousarray(stored[name], _DTYPES[name]) for name in stored}
    with whole_file(path) as part:
        # Not by safetensors' own writer, whose error on a full disk is no OSError.
        part.write_bytes(save(stored, metadata={"format": f"{FORMAT} {VERSION}"}))


def read_field(path: str | Path) -> dict[str, np.ndarray]:
    """Read the arrays of `write_field`.

    Raises:
        InputError: no such file, or it is damaged, foreign, or of another version.
    """
    try:
        with safe_open(path, framework="numpy") as file:
            name, _, version = (file.metadata() or {}).get("format", "").partition(" ")
            if name != FORMAT:
                raise InputError(f"{path}: not a saved ShadowField. Give a file of `save`.")
            if version != VERSION:
                raise InputError(
                    f"{path}: version {version} of the format, not {VERSION}. Save it again with "
                    "this release, or use the release that wrote it."
                )
            arrays = {name: file.get_tensor(name) for name in file.keys()}
    except (OSError, SafetensorError) as error:
        reason = " ".join(str(error).split())[:200]
        raise InputError(f"{path}: cannot be read ({reason}). Copy or save it again.") from error
    if problem := _problem_of(arrays):
        raise InputError(f"{path}: damaged ({problem}). Copy or save it again.")
    cells = arrays.get("cells", np.empty(0, np.uint64))
    grid = grid_of(arrays["grid"])
    return {**arrays, "radius": float(arrays["radius"][0]), "grid": grid, "cells": cells}


def _problem_of(arrays: dict[str, np.ndarray]) -> str | None:
    """What does not fit in a file's arrays."""
    if missing := _DTYPES.keys() - {"cells"} - arrays.keys():
        return f"no {min(missing)}"
    for name, array in arrays.items():
        if name not in _DTYPES or array.dtype != np.dtype(_DTYPES[name]):
            return f"{name} is {array.dtype}"
    size, held = round(arrays["grid"].size ** (1 / 3)), int((arrays["grid"] == HELD).sum())
    shapes = {"centre": (3,), "radius": (1,), "grid": (max(size, 1),) * 3}
    shapes |= {"bricks": (held, BRICK_VERTICES), "cells": (held,)}
    for name, array in arrays.items():
        if array.shape != shapes[name]:
            return f"{name} is {array.shape}, not {shapes[name]}"
    if not (np.isfinite(arrays["centre"]).all() and 0 < arrays["radius"][0] < np.inf):
        return "no finite centre and radius"
    return None
