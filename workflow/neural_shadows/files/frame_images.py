"""Images of a frame: EXR files of a folder, or one npz.

An image is named `FILE:CHANNEL`: a channel of FILE.exr, or of the array FILE, (H, W) or (H, W, C) with
the channels R, G, B, A, in the folder's only npz file.
"""

from collections.abc import Mapping
from functools import cached_property
from pathlib import Path

import numpy as np
import OpenEXR

from neural_shadows.errors import InputError
from neural_shadows.files.whole_files import whole_file

_CHANNELS = "RGBA"


class FrameImages:
    """Images of a folder; each file is read once.

    Raises:
        InputError: the folder has no such files, or two npz files.
    """

    def __init__(self, folder: Path):
        self.folder = folder
        archives, pictures = sorted(folder.glob("*.npz")), [*folder.glob("*.exr")]
        if len(archives) > 1 or not (archives or pictures):
            raise InputError(
                f"{folder}: has {archives or 'no images'}. Put EXR files or one npz file there"
            )
        self._archive = archives[0] if archives else None
        self._read: dict[str, Mapping[str, np.ndarray]] = {}

    @property
    def form(self) -> str:
        """`npz` or `exr`."""
        return "npz" if self._archive else "exr"

    def place(self, image: str) -> str:
        """Location of an image: `FRAME/frame.npz: z:R` or `FRAME/z.exr: R`."""
        file, channel = image.rsplit(":", 1)
        return (
            f"{self._archive}: {image}" if self._archive else f"{self.folder}/{file}.exr: {channel}"
        )

    def image(self, image: str) -> np.ndarray | None:
        """Read an image, (H, W) float32; None without file or array.

        Raises:
            InputError: it cannot be read, or has no such channel.
        """
        file, channel = image.rsplit(":", 1)
        if file not in self._read:
            self._read[file] = self._of_npz(file) if self._archive else self._of_exr(file)
        channels = self._read[file]
        if channels and channel not in channels:
            raise InputError(
                f"{self.place(image)}: no such channel. Allowed: {', '.join(channels)}"
            )
        return channels[channel].astype(np.float32) if channels else None

    def _of_exr(self, file: str) -> Mapping[str, np.ndarray]:
        path = self.folder / f"{file}.exr"
        if not path.exists():
            return {}
        try:
            channels = OpenEXR.File(str(path), separate_channels=True).channels()
        except Exception as error:  # damaged files raise errors of many types
            raise InputError(f"{path}: damaged ({error})") from error
        return {name: channel.pixels for name, channel in channels.items()}

    def _of_npz(self, name: str) -> Mapping[str, np.ndarray]:
        if name not in self._arrays:
            return {}
        array = self._arrays[name]
        if array.ndim == 2:
            array = array[..., None]
        if (
            array.ndim != 3
            or not 1 <= array.shape[2] <= len(_CHANNELS)
            or array.dtype.kind not in "fiub"
        ):
            raise InputError(
                f"{self._archive}: {name} is {array.dtype} {array.shape}. Write numbers, (H, W) or "
                f"(H, W, C) with C up to {len(_CHANNELS)}"
            )
        return dict(zip(_CHANNELS, np.moveaxis(array, 2, 0)))

    @cached_property
    def _arrays(self) -> dict[str, np.ndarray]:
        try:
            with self._archive.open("rb") as file, np.load(file, allow_pickle=False) as arrays:
                return dict(arrays)
        except Exception as error:  # damaged archives raise errors of many types
            raise InputError(f"{self._archive}: damaged ({error})") from error


def write_images(path: Path, images: Mapping[str, np.ndarray]) -> None:
    """Write images (H, W) by name as half floats, to EXR or npz."""
    halves = {name: np.ascontiguousarray(image, np.float16) for name, image in images.items()}
    with whole_file(path) as part:
        if path.suffix == ".npz":
            np.savez_compressed(part, **halves)
            return
        header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
        OpenEXR.File(header, halves).write(str(part))
