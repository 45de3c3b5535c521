"""An engine's frame as ours are: its images to buffers, targets, and which pixels count."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from neural_shadows.errors import InputError
from neural_shadows.files.frame_images import FrameImages
from neural_shadows.frames.buffers import CHANNELS, LIT

# What a value may be, with room for the rounding of half floats.
_LIMITS = {
    **dict.fromkeys(("z", "z_b", "d"), (0, np.inf)),
    **dict.fromkeys(("c_e", "c_v", "agreement"), (-1.01, 1.01)),
    **dict.fromkeys((*LIT, "target"), (-0.001, 1.001)),
    **dict.fromkeys(("n_x", "n_y", "n_z", "e_x", "e_y", "e_z"), (-1.01, 1.01)),
}


class EngineFrame(NamedTuple):
    """Buffers (H, W) float32 by channel, in the order of `CHANNELS`: those that its images give; the
    targets (K, H, W) float32, of no radius where it has none; and (H, W) bool, where something is seen.
    """

    buffers: dict[str, np.ndarray]
    targets: np.ndarray
    valid: np.ndarray


def engine_frame(
    images: FrameImages,
    channels: Mapping[str, str | None],
    targets: Sequence[str],
    size: float,
) -> EngineFrame:
    """Read a frame.

    Bases are made dark where the point faces away from the light, as the loader of Hu et al. 2025 does.
    A channel whose file is missing is left out.

    Args:
        channels: names of images, by channel as `engine_channels` has them; None for none.
        targets: of each radius. size: of the scene, in the unit of the frame's distances.

    Raises:
        InputError: there is no z; an image cannot be read, is of another size than z, or holds what
            cannot be where something is seen; or some targets are missing.
    """
    if channels["z"] is None or (z := images.image(channels["z"])) is None:
        where = images.place(channels["z"]) if channels["z"] else images.folder
        raise InputError(f"{where}: missing; each frame needs z, the distance from the light")
    valid = z != 0
    if not valid.any():
        raise InputError(f"{images.place(channels['z'])}: is 0 everywhere: nothing is seen")

    found = {}
    for name, image in channels.items():
        if image is not None and (one := _read(images, image, name, valid)) is not None:
            found[name] = one
    known = [_read(images, image, "target", valid) for image in targets]
    lacking = [image for image, one in zip(targets, known) if one is None]
    if lacking and len(lacking) < len(targets):
        raise InputError(f"{images.place(lacking[0])}: missing, where the frame has other targets")
    exact = np.empty((0, *z.shape), np.float32) if lacking or not known else np.stack(known)
    exact = np.where(valid, np.clip(exact, 0, 1), np.float32(1))
    return EngineFrame(_as_ours(found, valid, size), exact, valid)


def _read(images: FrameImages, image: str, name: str, valid: np.ndarray) -> np.ndarray | None:
    """An image that is 0 where nothing is seen; None if there is no such file."""
    found = images.image(image)
    if found is None:
        return None
    where = images.place(image)
    if found.shape != valid.shape:
        (height, width), (rows, columns) = valid.shape, found.shape
        raise InputError(f"{where}: is {columns} × {rows}, but the frame's z {width} × {height}")
    wrong = valid & ~np.isfinite(found)
    if name == "z_b":
        wrong &= ~np.isposinf(found)  # where the map shows nothing
    if wrong.any():
        row, column = np.argwhere(wrong)[0]
        raise InputError(
            f"{where}: NaN or infinity in {wrong.sum()} pixels, the first in row {row}, column {column}; "
            "where nothing is seen, z should be 0"
        )
    found = np.where(valid, found, np.float32(0))
    low, high = _LIMITS[name]
    if found.min() < low or found.max() > high:
        raise InputError(
            f"{where}: {name} is from {found.min():g} to {found.max():g}; should be "
            f"{'0 or more' if high == np.inf else f'in [{round(low)}, {round(high)}]'}"
        )
    return found


def _as_ours(found: dict[str, np.ndarray], valid: np.ndarray, size: float) -> dict[str, np.ndarray]:
    """The channels of `frames.buffers` that can be made of an engine's."""
    found = dict(found)
    if "z_b" in found:
        z_b = found.pop("z_b")
        found["gap"] = np.where(np.isfinite(z_b), z_b - found["z"], 0)
    for name in ("z", "gap", "d"):
        if name in found:
            found[name] = found[name] / np.float32(size)
    for name in LIT:
        if name in found:
            faces = found["c_e"] > 0 if "c_e" in found else True
            found[name] = np.where(valid, np.clip(found[name], 0, 1) * faces, 1)
    return {name: found[name].astype(np.float32) for name in CHANNELS if name in found}
