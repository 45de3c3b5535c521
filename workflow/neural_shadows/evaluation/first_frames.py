"""The frames that people look at: the first view of each set by every method, with its scores."""

import io
import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from zipfile import ZipFile, ZipInfo

import numpy as np

from neural_shadows.evaluation.per_view_metrics import read_metrics
from neural_shadows.files.broken import broken, reading

CAPTIONS = {
    "shadow": "aimed at the cast shadow",
    "surface": "aimed at the object's surface (self-shadowing)",
    "centre": "aimed at the object's centre",
}

MOST_BYTES = 8192**2 + 2**16  # of a frame: the most pixels that a config may ask for
MOST_ALL_BYTES = 64 * MOST_BYTES  # of a file: more methods than any evaluation has


@dataclass
class FirstFrame:
    """A viewpoint by every method: 8-bit grey `images` (H, W), and `scores` by metric."""

    caption: str
    images: dict[str, np.ndarray] = field(default_factory=dict)
    scores: dict[str, dict[str, float]] = field(default_factory=dict)


def read_first_frames(pictures: Sequence[Path], metrics: Sequence[Path]) -> list[FirstFrame]:
    """Join what evaluations of one scene rendered of the first view of each view set.

    Args:
        pictures: frames as `evaluate` wrote them, one file for each evaluation and view set.
        metrics: the metrics of the same batches, in the same order.

    Raises:
        InputError: a file is missing; or not whole, and moved aside.
    """
    frames: dict[str, FirstFrame] = {}
    for picture_path, metrics_path in zip(pictures, metrics, strict=True):
        values = read_metrics([metrics_path])
        values = values[values["view"] == values["view"].iloc[0]]
        view_set = values["view_set"].iloc[0]
        if view_set not in CAPTIONS:
            raise broken(metrics_path, f"the view set {view_set!r} is unknown")
        frame = frames.setdefault(view_set, FirstFrame(CAPTIONS[view_set]))
        frame.images |= _read_images(picture_path)
        frame.scores |= {
            method: dict(zip(group["metric"], group["value"]))
            for method, group in values.groupby("method")
        }
    return list(frames.values())


def _read_images(path: Path) -> dict[str, np.ndarray]:
    """The 8-bit grey frames (H, W) by method, and `reference`, that `evaluate` wrote.

    Raises:
        InputError: the file is missing or not whole, and moved aside.
    """
    with reading(path, "file of frames"):
        content = path.read_bytes()
        try:
            return _unpack_images(content)
        except MemoryError:
            raise
        except Exception as error:  # whatever a damaged archive makes zipfile and zlib raise
            raise ValueError(error) from error


def _unpack_images(content: bytes) -> dict[str, np.ndarray]:
    with ZipFile(io.BytesIO(content)) as archive:
        members = archive.infolist()
        if sum(member.file_size for member in members) > MOST_ALL_BYTES:
            raise ValueError(f"unpacks to more than {MOST_ALL_BYTES:,} bytes")
        images = {
            member.filename.removesuffix(".npy"): _read_image(archive, member) for member in members
        }
    shape = images["reference"].shape
    if 0 in shape or any(image.shape != shape for image in images.values()):
        raise ValueError(f"frames of different sizes, or of none: {shape}")
    return images


def _read_image(archive: ZipFile, member: ZipInfo) -> np.ndarray:
    """An array of an `.npz`, if it is a frame; nothing is unpacked that is larger than one."""
    if member.file_size > MOST_BYTES:
        raise ValueError(f"{member.filename} unpacks to {member.file_size:,} bytes")
    with archive.open(member) as file:
        np.lib.format.read_magic(file)
        shape, by_columns, dtype = np.lib.format.read_array_header_1_0(file)
        pixels = np.frombuffer(file.read(), np.uint8)
    if dtype != np.uint8 or len(shape) != 2 or math.prod(shape) != len(pixels):
        raise ValueError(f"{member.filename} holds {len(pixels):,} bytes as {dtype} {shape}")
    return pixels.reshape(shape, order="F" if by_columns else "C")
