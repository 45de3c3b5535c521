"""Where the samples of screen-space networks come from: crops of frames on disk."""

from collections.abc import Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import torch
from torch import Tensor

from neural_shadows.errors import InputError
from neural_shadows.frames.aligned_twins import ALIGNED_BY, twin_pixels
from neural_shadows.frames.feature_names import BASES
from neural_shadows.frames.features import buffers_of, named_features
from neural_shadows.frames.frame_set import FrameSetPart
from neural_shadows.frames.light_size import light_size
from neural_shadows.rendering.gbuffer import Lens, lens_of
from neural_shadows.training.screen_crops import Crops, Place


class ScreenFrames:
    """Frames of some parts of a frame set, all of one size and with lights of as many radii.

    Args:
        parts: their JSON files.
        features: names of the channels that a network is told, see `named_features`; those of them
            that are shadows already are its `bases`.

    Raises:
        InputError: there is no frame, a part is damaged, or they differ in size, radii or twins.
    """

    def __init__(self, parts: Sequence[Path], features: Sequence[str]):
        self._features, self._buffers = tuple(features), buffers_of(features)
        self.bases = [name for name in self._features if name in BASES]
        self.parts = [FrameSetPart(path) for path in parts]
        self._frames = [(part, number) for part in self.parts for number in range(len(part))]
        if not self._frames:
            raise InputError("the frame set has no frames of this use; render some, or use another")
        kinds = {part.targets.shape[1:] + part.buffers.shape[1:2] for part in self.parts}
        if len(kinds) > 1:
            raise InputError(
                f"{parts[0].parent}: its parts differ in size, radii or twins; a network is trained "
                "on frames that are alike"
            )
        ((self.radii, self.height, self.width, versions),) = kinds
        self.twins = versions - 1
        self._lenses: dict[Any, Lens] = {}

    def __len__(self) -> int:
        return len(self._frames)

    @cached_property
    def about(self) -> Mapping[str, Any]:
        """The description of the first part."""
        return self.parts[0].about

    def crop(self, place: Place, side: int, aligned: bool = False) -> Crops:
        """A crop, B = 1.

        Args:
            aligned: whether its twin is compared where it shows the same.

        Raises:
            InputError: it holds NaN or infinity.
        """
        part, number = self._frames[place.frame]
        window = (
            slice(place.top, place.top + side),
            slice(place.left, place.left + side),
        )
        target = np.float32(part.targets[number, place.radius][window])
        turned = [axis for axis, turn in ((-2, place.upside_down), (-1, place.mirrored)) if turn]

        def picture(array: np.ndarray) -> Tensor:
            array = np.flip(array, turned).copy()  # torch takes none that cannot be written to
            return torch.from_numpy(array).reshape(1, -1, *array.shape[-2:])

        versions = [0, place.twin] if place.twin else [0]
        features = [
            picture(self.features(place.frame, place.radius, one, window)) for one in versions
        ]
        valid = [part.valid[number, one][window] for one in versions]
        target = picture(target)
        self._check_finite(place.frame, [*features, target])
        found = Crops(features[0], target, picture(valid[0]), None, None, None)
        if not place.twin:
            return found
        found = found._replace(twin=features[1], twin_valid=picture(valid[1]))
        if not aligned:
            return found
        counts, at = self._aligned(place, window, valid[1])
        return found._replace(twin_valid=picture(counts), twin_at=picture(at))

    def _aligned(
        self, place: Place, window: tuple[slice, slice], valid: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Which pixels of a crop its twin shows, and where in the twin's crop as it is turned."""
        part, number = self._frames[place.frame]
        settings = part.setting(number), part.twin_setting(number, place.twin - 1)
        seen = [
            value
            for version, setting in zip((0, place.twin), settings)
            for value in (setting.camera, self._read(place.frame, version, ALIGNED_BY))
        ]
        found = twin_pixels(*seen, part.about["size"])
        counts, row, column = (one[window] for one in found)
        row, column = row - place.top, column - place.left
        height, width = valid.shape
        inside = (row >= 0) & (row < height) & (column >= 0) & (column < width)
        row, column = np.where(inside, row, 0), np.where(inside, column, 0)
        counts = counts & inside & valid[row, column]
        row = height - 1 - row if place.upside_down else row
        column = width - 1 - column if place.mirrored else column
        return counts, row * width + column

    def _read(
        self, frame: int, version: int, names: Sequence[str], window=(slice(None), slice(None))
    ) -> dict[str, np.ndarray]:
        """Buffers of a frame (version 0) or a twin by name, (h, w) float32."""
        part, number = self._frames[frame]
        return {name: part.image(number, name, version, window) for name in names}

    def features(
        self, frame: int, radius: int, version: int = 0, window=(slice(None), slice(None))
    ) -> np.ndarray:
        """What the network is told of a frame (version 0) or a twin: (C, h, w) float32."""
        part, number = self._frames[frame]
        buffers = self._read(frame, version, self._buffers, window)
        lens = self._lens(part, number)
        light = light_size(part.radii[radius], max(part.radii), part.about["size"])
        return named_features(self._features, buffers, lens._replace(axis=lens.axis[window]), light)

    def ranges(self) -> tuple[np.ndarray, np.ndarray]:
        """Mean and standard deviation of each channel over valid pixels of up to 16 frames, for all
        radii together, (C,) float32 each; a deviation of 1 of one that is the same everywhere.
        """
        seen = [
            self.features(frame, radius)[:, self.valid(frame)]
            for frame in range(0, len(self), -(-len(self) // 16))
            for radius in range(self.radii)
        ]
        together = np.concatenate(seen, axis=1)
        spreads = together.std(axis=1)
        return together.mean(axis=1), np.where(spreads > 1e-6, spreads, 1).astype(np.float32)

    def target(self, frame: int, radius: int) -> np.ndarray:
        """The exact soft shadow, (H, W) float32."""
        part, number = self._frames[frame]
        return np.float32(part.targets[number, radius])

    def base(self, name: str, frame: int) -> np.ndarray:
        """Visibility by one of `BASES`, (H, W) float32."""
        part, number = self._frames[frame]
        return part.image(number, name.removeprefix("base_"))

    def valid(self, frame: int) -> np.ndarray:
        """Which pixels count, (H, W) bool."""
        part, number = self._frames[frame]
        return part.valid[number, 0]

    def _lens(self, part: FrameSetPart, number: int) -> Lens:
        # A twin has its frame's field of view and window.
        camera = part.setting(number).camera
        key = camera.fov, camera.window
        if key not in self._lenses:
            if len(self._lenses) >= 64:  # windows are all different
                self._lenses.clear()
            self._lenses[key] = lens_of(camera, self.width, self.height)
        return self._lenses[key]

    def _check_finite(self, frame: int, arrays: Sequence[Tensor]) -> None:
        # A sum has what is not finite in it, at a tenth of the time of asking of each number.
        if not all(bool(one.sum(dtype=torch.float64).isfinite()) for one in arrays):
            part, number = self._frames[frame]
            raise InputError(
                f"{part.frames_json}: buffers or targets of frame {number} have NaN or infinity; "
                "delete the part and render it again"
            )
