"""Conversion of an engine's images to buffers, targets and a mask."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from neural_shadows.errors import InputError
from neural_shadows.files.frame_images import FrameImages
from neural_shadows.frames.buffers import CHANNELS, LIMITS, LIT, VISIBLE, out_of_range
from neural_shadows.running.progress import warn

_LARGEST = float(np.finfo(np.float16).max)  # 65504, of what a part holds
# The farthest point of a frame from eye or light, in shares of a size that may be right.
_SHARES = 0.05, 2.0

_LIMITS = {**LIMITS, "z_b": LIMITS["z"], "target": VISIBLE}


class EngineFrame(NamedTuple):
    """An engine's frame as arrays.

    Buffers (H, W) float32 by channel in the order of `CHANNELS`, those with images; targets
    (K, H, W) float32, K = 0 without targets; valid (H, W) bool, pixels with a surface.
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
    """Read an engine's frame.

    Bases are 0 where the point faces away from the light, as the loader of Hu et al. 2025 does.
    A channel whose file is missing is left out.

    Args:
        channels: names of images, by channel as `engine_channels` has them; None for none.
        targets: of each radius. size: of the scene, in the unit of the frame's distances.

    Raises:
        InputError: z is missing; an image cannot be read, differs from z in size, or has values out
            of range at valid pixels; some targets are missing; or distances are too many sizes for
            half floats.
    """
    if channels["z"] is None or (z := images.image(channels["z"])) is None:
        where = images.place(channels["z"]) if channels["z"] else images.folder
        raise InputError(f"{where}: missing. Each frame needs z, the distance from the light.")
    valid = z != 0
    if not valid.any():
        raise InputError(
            f"{images.place(channels['z'])}: is 0 everywhere: no pixel shows a surface."
        )

    buffers = {}
    for name, image in channels.items():
        if image is not None and (values := _read(images, image, name, valid)) is not None:
            buffers[name] = values
    shadows = [_read(images, image, "target", valid) for image in targets]
    lacking = [image for image, shadow in zip(targets, shadows) if shadow is None]
    if lacking and len(lacking) < len(targets):
        raise InputError(
            f"{images.place(lacking[0])}: missing, but the frame has other targets. Add it, or remove them."
        )
    exact = np.empty((0, *z.shape), np.float32) if lacking or not shadows else np.stack(shadows)
    exact = np.where(valid, np.clip(exact, 0, 1), np.float32(1))
    _check_size(images, buffers, size)
    return EngineFrame(_converted(buffers, valid, size), exact, valid)


def _check_size(images: FrameImages, channels: Mapping[str, np.ndarray], size: float) -> None:
    """Compare the farthest point with the scene's size."""
    farthest = max(float(channels[name].max()) for name in ("z", "d") if name in channels)
    what = (
        f"{images.folder}: its farthest z or d is {farthest:g}, {farthest / size:.3g} times "
        f"`engine.sizes.{images.folder.parent.name}` = {size:g}"
    )
    cure = "Give the longest side of the scene's bounding box, in the unit of z and d"
    if farthest / size > _LARGEST:
        raise InputError(f"{what}; half floats end at {_LARGEST:.0f}. {cure}")
    low, high = _SHARES
    if not low <= farthest / size <= high:
        warn(f"{what}; {low:g} to {high:g} times is usual, and all lights scale with it. {cure}")


def _read(images: FrameImages, image: str, name: str, valid: np.ndarray) -> np.ndarray | None:
    """Read an image, 0 without a surface; None without a file."""
    values = images.image(image)
    if values is None:
        return None
    where = images.place(image)
    if values.shape != valid.shape:
        (height, width), (rows, columns) = valid.shape, values.shape
        raise InputError(f"{where}: is {columns} × {rows}, but the frame's z {width} × {height}")
    wrong = valid & ~np.isfinite(values)
    if name == "z_b":
        wrong &= ~np.isposinf(values)  # no surface in the map
    if wrong.any():
        row, column = np.argwhere(wrong)[0]
        raise InputError(
            f"{where}: NaN or infinity in {wrong.sum()} pixels, the first in row {row}, column {column}. "
            "Set z to 0 where there is no surface"
            + (
                f". Half floats end at {_LARGEST:.0f}: write farther points in 32 bits or a larger unit"
                if np.isposinf(values[wrong]).any()
                else ""
            )
        )
    values = np.where(valid, values, np.float32(0))
    if wrong := out_of_range(values, *_LIMITS[name]):
        raise InputError(f"{where}: {name} is {wrong}")
    return values


def _converted(
    channels: dict[str, np.ndarray], valid: np.ndarray, size: float
) -> dict[str, np.ndarray]:
    """Convert an engine's channels to those of `frames.buffers`."""
    buffers = dict(channels)
    if "z_b" in buffers:
        z_b = buffers.pop("z_b")
        buffers["gap"] = np.where(np.isfinite(z_b), z_b - buffers["z"], 0)
    for name in ("z", "gap", "d"):
        if name in buffers:  # a map may show something as far as its numbers go
            buffers[name] = np.minimum(buffers[name] / np.float32(size), _LARGEST)
    for name in LIT:
        if name in buffers:
            faces = buffers["c_e"] > 0 if "c_e" in buffers else True
            buffers[name] = np.where(valid, np.clip(buffers[name], 0, 1) * faces, 1)
    return {name: buffers[name].astype(np.float32) for name in CHANNELS if name in buffers}
