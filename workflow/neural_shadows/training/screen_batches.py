"""Where the samples of screen-space networks come from: crops of frames on disk."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import torch
from torch import Tensor

from neural_shadows.errors import InputError
from neural_shadows.frames.buffers import CHANNELS
from neural_shadows.frames.features import buffers_of, named_features
from neural_shadows.frames.frame_set import FrameSetPart
from neural_shadows.frames.light_size import light_size
from neural_shadows.rendering.gbuffer import Lens, lens_of
from neural_shadows.training.batches import batch_indices

_DRAWS = 7  # numbers that are drawn for a crop


@dataclass(frozen=True)
class Place:
    """Which crop: of a frame, a radius and a twin, and where it lies in the frame."""

    frame: int
    radius: int
    twin: int  # from 1; 0 where none is wanted
    top: int
    left: int
    upside_down: bool
    mirrored: bool


class Crops(NamedTuple):
    """B crops: features (B, C, h, w) float32, of a twin too if one is wanted; target (B, 1, h, w)
    float32; which pixels count, (B, 1, h, w) bool.
    """

    features: Tensor
    target: Tensor
    valid: Tensor
    twin: Tensor | None
    twin_valid: Tensor | None

    def to(self, device: torch.device) -> "Crops":
        """The same on a device."""
        return Crops(*(one if one is None else one.to(device) for one in self))


class ScreenFrames:
    """Frames of some parts of a frame set, all of one size and with lights of as many radii.

    Args:
        parts: their JSON files.
        features: names of the channels that a network is told, see `named_features`.

    Raises:
        InputError: there is no frame, a part is damaged, or they differ in size, radii or twins.
    """

    def __init__(self, parts: Sequence[Path], features: Sequence[str]):
        self._features, self._buffers = tuple(features), buffers_of(features)
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

    def places(
        self, step: int, *, seed: int, crops: int, crop: int, flips: bool, twins: bool
    ) -> list[Place]:
        """The crops of a step; they depend on (seed, step) alone.

        Args:
            crop: side in pixels; where the frame is smaller, all of it is taken.
            twins: whether each has one of the frame's twins.
        """
        drawn = batch_indices(
            torch.tensor(step), seed=seed, batch_size=_DRAWS * crops, count=1 << 62
        )
        spare = [max(side - crop, 0) + 1 for side in (self.height, self.width)]
        versions = self.twins if twins else 1
        sides = 2 if flips else 1
        bounds = torch.tensor([len(self), self.radii, versions, *spare, sides, sides])
        chosen = (drawn.view(crops, _DRAWS) % bounds).tolist()
        return [
            Place(frame, radius, twin + 1 if twins else 0, top, left, bool(down), bool(mirrored))
            for frame, radius, twin, top, left, down, mirrored in chosen
        ]

    def crop(self, place: Place, side: int) -> Crops:
        """A crop, B = 1.

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
        valid = [picture(part.valid[number, one][window]) for one in versions]
        target = picture(target)
        self._check_finite(place.frame, [*features, target])
        return Crops(
            features[0],
            target,
            valid[0],
            features[1] if place.twin else None,
            valid[1] if place.twin else None,
        )

    def features(
        self, frame: int, radius: int, version: int = 0, window=(slice(None), slice(None))
    ) -> np.ndarray:
        """What the network is told of a frame (version 0) or a twin: (C, h, w) float32."""
        part, number = self._frames[frame]
        buffers = {
            name: np.float32(part.buffers[number, version, CHANNELS.index(name)][window])
            for name in self._buffers
        }
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

    def hard_map(self, frame: int) -> np.ndarray:
        """Visibility by the light's map, unfiltered: (H, W) float32."""
        part, number = self._frames[frame]
        return np.float32(part.buffers[number, 0, CHANNELS.index("hard")])

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
