"""A batch of reference frames on disk: the G-buffer and the reference's visibility of each view.

One safetensors file: tensors `NUMBER.NAME` of each view, and in the header the frames' size and
the viewpoints. A view of 600 × 400 takes about 3 MB.
"""

import json
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from safetensors import SafetensorError, safe_open
from safetensors.numpy import save

from neural_shadows.errors import InputError
from neural_shadows.files.whole_files import whole_file
from neural_shadows.rendering.gbuffer import GBuffer
from neural_shadows.scenes.cameras import Viewpoint

# Bits of `surface`, which has a byte a pixel.
_OBJECT, _GROUND, _LIT_SIDE = 1, 2, 4


def write_references(path: Path, frames: Iterable[tuple[GBuffer, np.ndarray]]) -> None:
    """Write frames of one size, each with the visibility (n,) of its n surface points."""
    tensors: dict[str, np.ndarray] = {}
    header: dict[str, Any] = {"views": []}
    for number, (frame, visibility) in enumerate(frames):
        tensors |= {f"{number}.{name}": array for name, array in _arrays(frame, visibility).items()}
        header |= {"width": frame.width, "height": frame.height}
        header["views"].append(asdict(frame.view))
    text = json.dumps(header, default=np.ndarray.tolist)
    with whole_file(path) as part:
        part.write_bytes(save(tensors, metadata={"header": text}))


def _arrays(frame: GBuffer, visibility: np.ndarray) -> dict[str, np.ndarray]:
    surface = np.zeros(frame.height * frame.width, np.uint8)
    surface[frame.pixel] = np.where(frame.is_object, _OBJECT, _GROUND)
    surface[frame.pixel[frame.lit_side]] |= _LIT_SIDE
    return {
        "surface": surface,
        "p": frame.p,
        "cos_geometric": frame.cos_geometric,
        "cos_shading": frame.cos_shading,
        "visibility": visibility[frame.lit_side],
    }


class References(Sequence[tuple[GBuffer, np.ndarray]]):
    """The frames of a file, each with its reference visibility (n,); read when asked for."""

    def __init__(self, path: Path):
        """Open the file.

        Raises:
            InputError: it is missing, or damaged.
        """
        try:
            self._file = safe_open(path, framework="numpy")
            header = json.loads(self._file.metadata()["header"])
        except (OSError, SafetensorError, TypeError, KeyError) as error:
            raise InputError(f"{path}: cannot be read ({error}); delete it and run again") from error
        self.width, self.height = header["width"], header["height"]
        self.views = [_viewpoint(view) for view in header["views"]]

    def __len__(self) -> int:
        return len(self.views)

    def __getitem__(self, number: int) -> tuple[GBuffer, np.ndarray]:
        arrays = {name: self._file.get_tensor(f"{number}.{name}") for name in _NAMES}
        surface = arrays["surface"]
        # As `render_gbuffer` orders them: the object's pixels, then the ground's.
        on_object = np.flatnonzero(surface & _OBJECT)
        pixel = np.concatenate([on_object, np.flatnonzero(surface & _GROUND)])
        frame = GBuffer(
            view=self.views[number],
            width=self.width,
            height=self.height,
            pixel=pixel,
            is_object=np.arange(len(pixel)) < len(on_object),
            lit_side=np.flatnonzero(surface[pixel] & _LIT_SIDE),
            p=arrays["p"],
            cos_geometric=arrays["cos_geometric"],
            cos_shading=arrays["cos_shading"],
        )
        return frame, frame.visibility(arrays["visibility"])


def _viewpoint(view: dict[str, Any]) -> Viewpoint:
    vectors = {key: np.array(view[key]) for key in ("eye", "target", "up", "light")}
    return Viewpoint(**view | vectors)
