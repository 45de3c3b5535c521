"""Reference frames on disk: G-buffer and exact visibility by view.

One safetensors file: tensors `NUMBER.NAME` of each view, and in the header the frames' size, the
ground and the viewpoints. The ground's points follow from these: a view of 600 × 400 takes
2 MB instead of 5.
"""

import json
from collections.abc import Iterable
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from safetensors import SafetensorError, safe_open
from safetensors.numpy import save

from neural_shadows.errors import InputError
from neural_shadows.files.whole_files import whole_file
from neural_shadows.rendering.gbuffer import GBuffer, ground_points, with_ground
from neural_shadows.scenes.cameras import Viewpoint

# Bits of the tensor `surface`, which has a byte a pixel.
_OBJECT, _GROUND, _LIT_SIDE = 1, 2, 4

# Tensors of the object's lit side alone; `visibility` is of the ground's as well.
_OF_OBJECT = ("p", "cos_geometric", "cos_shading")

# Of a viewpoint, which are lists in the header.
_VECTORS = ("eye", "target", "up", "light")


def write_references(
    path: Path, frames: Iterable[tuple[GBuffer, np.ndarray]], ground: float | None
) -> None:
    """Write frames of one size; visibility is (n,) of n points.

    Args:
        ground: height of the scene's ground plane.
    """
    tensors: dict[str, np.ndarray] = {}
    header: dict[str, Any] = {"ground": ground, "views": []}
    for number, (frame, visibility) in enumerate(frames):
        surface = np.zeros(frame.height * frame.width, np.uint8)
        surface[frame.pixel] = np.where(frame.is_object, _OBJECT, _GROUND)
        surface[frame.pixel[frame.lit_side]] |= _LIT_SIDE
        on_object = np.count_nonzero(frame.is_object[frame.lit_side])  # the object's come first
        tensors[f"{number}.surface"] = surface
        tensors[f"{number}.visibility"] = visibility[frame.lit_side]
        for name in _OF_OBJECT:
            tensors[f"{number}.{name}"] = getattr(frame, name)[:on_object]
        header |= {"width": frame.width, "height": frame.height}
        header["views"].append(asdict(frame.view))
    text = json.dumps(header, default=np.ndarray.tolist)
    with whole_file(path) as part:
        part.write_bytes(save(tensors, metadata={"header": text}))


class References:
    """Frames of a file with reference visibility (n,), read lazily."""

    def __init__(self, path: Path):
        """Open the file.

        Raises:
            InputError: it is missing, or damaged.
        """
        try:
            self._file = safe_open(path, framework="numpy")
            header = json.loads(self._file.metadata()["header"])
        except (OSError, SafetensorError, TypeError, KeyError) as error:
            raise InputError(f"{path}: damaged ({error}). Delete it and run again.") from error
        self.width, self.height = header["width"], header["height"]
        self.ground: float | None = header["ground"]
        self.views = [
            Viewpoint(**view | {name: np.array(view[name]) for name in _VECTORS})
            for view in header["views"]
        ]

    def __len__(self) -> int:
        return len(self.views)

    def __getitem__(self, number: int) -> tuple[GBuffer, np.ndarray]:
        view = self.views[number]  # an IndexError ends an iteration
        surface = self._file.get_tensor(f"{number}.surface")
        pixel = np.flatnonzero(surface & _OBJECT)
        frame = GBuffer(
            view=view,
            width=self.width,
            height=self.height,
            pixel=pixel,
            is_object=np.ones(len(pixel), bool),
            lit_side=np.flatnonzero(surface[pixel] & _LIT_SIDE),
            **{name: self._file.get_tensor(f"{number}.{name}") for name in _OF_OBJECT},
        )
        if self.ground is not None:
            pixel = np.flatnonzero(surface & _GROUND)
            p = ground_points(frame.view, self.width, self.height, pixel, self.ground)
            frame = with_ground(frame, pixel, p)
        return frame, frame.visibility(self._file.get_tensor(f"{number}.visibility"))
