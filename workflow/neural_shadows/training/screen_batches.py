"""Samples of screen-space networks: crops of frames on disk."""

from collections.abc import Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import torch
from torch import Tensor

from neural_shadows.errors import InputError
from neural_shadows.frames.aligned_twins import ALIGNED_BY, twin_pixels
from neural_shadows.frames.feature_names import BASES, TRACED, buffers_of, channels_of
from neural_shadows.frames.features import named_features
from neural_shadows.frames.frame_set import FrameSetPart
from neural_shadows.rendering.gbuffer import Lens, lens_of
from neural_shadows.training.screen_crops import Crops, CropSample


class ScreenFrames:
    """Frames of a frame set's parts: one size, equally many radii.

    Args:
        parts: their JSON files.
        features: names of a network's channels, see `named_features`; the shadows among them are
            its `bases`.

    Raises:
        InputError: no frame, a damaged part, or parts of different sizes, radii or perturbed
            frames.
    """

    def __init__(self, parts: Sequence[Path], features: Sequence[str]):
        self._features, self._buffers = tuple(features), buffers_of(features)
        self.bases = [name for name in self._features if name in BASES]
        self.parts = [FrameSetPart(path) for path in parts]
        self._frames = [(part, number) for part in self.parts for number in range(len(part))]
        if not self._frames:
            raise InputError(
                "the frame set has no frames for this use. Render some, or use another frame set."
            )
        kinds = {part.targets.shape[1:] + part.buffers.shape[1:2] for part in self.parts}
        if len(kinds) > 1:
            raise InputError(
                f"{parts[0].parent}: parts differ in size, radii or perturbed frames. Give them all "
                "the same."
            )
        ((self.radii, self.height, self.width, versions),) = kinds
        self.twins = versions - 1
        self._lenses: dict[Any, Lens] = {}

    def __len__(self) -> int:
        return len(self._frames)

    @cached_property
    def about(self) -> Mapping[str, Any]:
        """Description of the first part."""
        return self.parts[0].about

    def crop(self, sample: CropSample, side: int, aligned: bool = False) -> Crops:
        """Read a crop, B = 1.

        Args:
            aligned: compare the perturbed frame at the same surface points.

        Raises:
            InputError: NaN or infinity.
        """
        part, number = self._frames[sample.frame]
        window = slice(sample.top, sample.top + side), slice(sample.left, sample.left + side)
        target = np.float32(part.targets[number, sample.radius][window])
        flipped_axes = [
            axis for axis, flipped in ((-2, sample.upside_down), (-1, sample.mirrored)) if flipped
        ]

        def picture(array: np.ndarray) -> Tensor:
            array = np.flip(array, flipped_axes).copy()  # torch takes no read-only arrays
            return torch.from_numpy(array).reshape(1, -1, *array.shape[-2:])

        versions = [0, sample.twin] if sample.twin else [0]
        features = [
            picture(self.features(sample.frame, sample.radius, version, window))
            for version in versions
        ]
        valid = [part.valid[number, version][window] for version in versions]
        target = picture(target)
        self._check_finite(sample.frame, [*features, target])
        crops = Crops(features[0], target, picture(valid[0]), None, None, None)
        if not sample.twin:
            return crops
        crops = crops._replace(twin=features[1], twin_valid=picture(valid[1]))
        if not aligned:
            return crops
        visible, indices = self._aligned(sample, window, valid[1])
        return crops._replace(twin_valid=picture(visible), twin_at=picture(indices))

    def _aligned(
        self, sample: CropSample, window: tuple[slice, slice], valid: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Visible pixels of a crop in its perturbed crop; their indices."""
        part, number = self._frames[sample.frame]
        settings = part.setting(number), part.twin_setting(number, sample.twin - 1)
        views = [
            value
            for version, setting in zip((0, sample.twin), settings)
            for value in (setting.camera, self._read(sample.frame, version, ALIGNED_BY))
        ]
        pixels = twin_pixels(*views, part.about["size"])
        visible, row, column = (array[window] for array in pixels)
        row, column = row - sample.top, column - sample.left
        height, width = valid.shape
        inside = (row >= 0) & (row < height) & (column >= 0) & (column < width)
        row, column = np.where(inside, row, 0), np.where(inside, column, 0)
        visible = visible & inside & valid[row, column]
        row = height - 1 - row if sample.upside_down else row
        column = width - 1 - column if sample.mirrored else column
        return visible, row * width + column

    def _read(
        self, frame: int, version: int, names: Sequence[str], window=(slice(None), slice(None))
    ) -> dict[str, np.ndarray]:
        """Buffers of a frame (version 0) or perturbed frame, (h, w) float32."""
        part, number = self._frames[frame]
        return {name: part.image(number, name, version, window) for name in names}

    def _read_rays(self, frame: int, radius: int, version: int, window) -> dict[str, np.ndarray]:
        """Buffers by rays of a frame, (h, w) float32."""
        part, number = self._frames[frame]
        if version or not part.rays:
            what = "perturbed frames" if version else "frames"
            raise InputError(
                f"{part.frames_json}: has no rays of its {what}, which the features {', '.join(TRACED)} "
                "need. Give the frame set `rays: 1` or more, and the training `perturbation: 0`"
            )
        return {
            name: np.float32(image[window])
            for name, image in zip(TRACED, part.traced[number, radius])
        }

    def features(
        self, frame: int, radius: int, version: int = 0, window=(slice(None), slice(None))
    ) -> np.ndarray:
        """Network input of a frame (version 0) or perturbed frame: (C, h, w) float32."""
        part, number = self._frames[frame]
        stored = [name for name in self._buffers if name not in TRACED]
        buffers = self._read(frame, version, stored, window)
        if len(stored) < len(self._buffers):
            buffers |= self._read_rays(frame, radius, version, window)
        lens = self._lens(part, number)
        light = part.light_size(part.radii[radius])
        return named_features(self._features, buffers, lens._replace(axis=lens.axis[window]), light)

    def ranges(self) -> tuple[np.ndarray, np.ndarray]:
        """Mean and standard deviation of each channel, (C,) float32 each.

        Over valid pixels of up to 16 frames, for all radii together; deviation 1 of a constant
        channel.
        """
        count, sums = 0, np.zeros((2, channels_of(self._features)))
        # A frame at a time: of 2048 × 1024 all together are 10 GB.
        for frame in range(0, len(self), -(-len(self) // 16)):
            for radius in range(self.radii):
                pixels = np.float64(self.features(frame, radius)[:, self.valid(frame)])
                count += pixels.shape[1]
                sums += pixels.sum(axis=1), np.square(pixels).sum(axis=1)
        means, squares = sums / count
        deviations = np.sqrt(np.maximum(squares - means**2, 0))
        return np.float32(means), np.float32(np.where(deviations > 1e-6, deviations, 1))

    def target(self, frame: int, radius: int) -> np.ndarray:
        """The exact soft shadow, (H, W) float32."""
        part, number = self._frames[frame]
        return np.float32(part.targets[number, radius])

    def base(self, name: str, frame: int, radius: int) -> np.ndarray:
        """Visibility by one of `BASES`, (H, W) float32; by rays of a radius, the others of a point."""
        part, number = self._frames[frame]
        if name == "base_rays":
            return self._read_rays(frame, radius, 0, (slice(None), slice(None)))["rays"]
        return part.image(number, name.removeprefix("base_"))

    def valid(self, frame: int) -> np.ndarray:
        """Valid pixels, (H, W) bool."""
        part, number = self._frames[frame]
        return part.valid[number, 0]

    def _lens(self, part: FrameSetPart, number: int) -> Lens:
        # A perturbed frame has its frame's field of view and window.
        camera = part.setting(number).camera
        key = camera.fov, camera.window
        if key not in self._lenses:
            if len(self._lenses) >= 64:  # windows are all different
                self._lenses.clear()
            self._lenses[key] = lens_of(camera, self.width, self.height)
        return self._lenses[key]

    def _check_finite(self, frame: int, arrays: Sequence[Tensor]) -> None:
        # A sum propagates NaN and infinity, in a tenth of the time of testing each number.
        if not all(bool(array.sum(dtype=torch.float64).isfinite()) for array in arrays):
            part, number = self._frames[frame]
            raise InputError(
                f"{part.frames_json}: NaN or infinity in buffers or targets of frame {number}. "
                "Delete the part and render it again."
            )
