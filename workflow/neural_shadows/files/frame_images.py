"""Images of a frame that another program wrote: EXR files in a folder, or the arrays of one npz.

An image is named `FILE:CHANNEL`. It is the channel of FILE.exr; or of an array called FILE, (H, W) or
(H, W, C) with the channels R, G, B, A, in the only npz file of the folder.
"""

from collections.abc import Mapping
from functools import cached_property
from pathlib import Path

import numpy as np
import OpenEXR

from neural_shadows.errors import InputError
from neural_shadows.files.whole_files import whole_file

_ORDER = "RGBA"  # of an array's channels


class FrameImages:
    """The images of a folder, each file read once.

    Raises:
        InputError: the folder has no such files, or two npz files.
    """

    def __init__(self, folder: Path):
        self.folder = folder
        archives, pictures = sorted(folder.glob("*.npz")), [*folder.glob("*.exr")]
        if len(archives) > 1 or not (archives or pictures):
            raise InputError(
                f"{folder}: should have EXR files or one npz file, {archives or 'none'}"
            )
        self._archive = archives[0] if archives else None
        self._read: dict[str, Mapping[str, np.ndarray]] = {}

    @property
    def form(self) -> str:
        """`npz` or `exr`."""
        return "npz" if self._archive else "exr"

    def place(self, image: str) -> str:
        """Where an image is, in words: `FRAME/frame.npz: z:R` or `FRAME/z.exr: R`."""
        file, channel = image.rsplit(":", 1)
        return (
            f"{self._archive}: {image}" if self._archive else f"{self.folder}/{file}.exr: {channel}"
        )

    def image(self, image: str) -> np.ndarray | None:
        """An image, (H, W) float32; None if there is no such file or array.

        Raises:
            InputError: it cannot be read, or has no such channel.
        """
        file, channel = image.rsplit(":", 1)
        if file not in self._read:
            self._read[file] = self._of_npz(file) if self._archive else self._of_exr(file)
        found = self._read[file]
        if found and channel not in found:
            raise InputError(f"{self.place(image)}: no such channel; there is {', '.join(found)}")
        return found[channel].astype(np.float32) if found else None

    def _of_exr(self, file: str) -> Mapping[str, np.ndarray]:
        path = self.folder / f"{file}.exr"
        if not path.exists():
            return {}
        try:
            channels = OpenEXR.File(str(path), separate_channels=True).channels()
        except Exception as error:  # RuntimeError, and whatever a damaged file makes it raise
            raise InputError(f"{path}: damaged ({error})") from error
        return {name: one.pixels for name, one in channels.items()}

    def _of_npz(self, name: str) -> Mapping[str, np.ndarray]:
        if name not in self._arrays:
            return {}
        array = self._arrays[name]
        if array.ndim == 2:
            array = array[..., None]
        if (
            array.ndim != 3
            or not 1 <= array.shape[2] <= len(_ORDER)
            or array.dtype.kind not in "fiub"
        ):
            raise InputError(
                f"{self._archive}: {name} is {array.dtype} {array.shape}; should be numbers, (H, W) or "
                f"(H, W, C) with C up to {len(_ORDER)}"
            )
        return dict(zip(_ORDER, np.moveaxis(array, 2, 0)))

    @cached_property
    def _arrays(self) -> dict[str, np.ndarray]:
        try:
            with self._archive.open("rb") as file, np.load(file, allow_pickle=False) as arrays:
                return dict(arrays)
        except Exception as error:  # whatever a damaged archive makes zipfile and zlib raise
            raise InputError(f"{self._archive}: damaged ({error})") from error


def write_images(path: Path, images: Mapping[str, np.ndarray]) -> None:
    """Write images (H, W) by name in half floats: the channels of an EXR file, or the arrays of an
    npz, as the path's suffix says.
    """
    halves = {name: np.ascontiguousarray(one, np.float16) for name, one in images.items()}
    with whole_file(path) as part:
        if path.suffix == ".npz":
            np.savez_compressed(part, **halves)
            return
        header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
        OpenEXR.File(header, halves).write(str(part))
