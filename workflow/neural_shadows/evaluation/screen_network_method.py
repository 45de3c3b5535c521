"""Trained screen-space networks as methods. From Datta et al. 2022 and Hu et al. 2025."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import torch

from neural_shadows.errors import InputError
from neural_shadows.evaluation.method import Method
from neural_shadows.frames.buffers import LIT, channel_images
from neural_shadows.frames.feature_names import TRACED, buffers_of
from neural_shadows.frames.features import named_features
from neural_shadows.frames.frame_set import FrameSetPart
from neural_shadows.frames.light_size import LightSize, light_size
from neural_shadows.frames.ray_tracing import traced_images
from neural_shadows.frames.soft_frame import SoftFrame
from neural_shadows.networks.compute import choose_dtype, is_native
from neural_shadows.networks.screen_space.screen_networks import load_screen_network
from neural_shadows.networks.weight_file import load_tensors
from neural_shadows.rendering.gbuffer import Lens, lens_of
from neural_shadows.rendering.light_shape import LightShape, light_shape

_CPU = torch.device("cpu")  # device of all methods for soft shadows


def screen_method(weights: Path, precision: str = "auto") -> Method:
    """The method of a file of weights, in a number format. See `choose_dtype`.

    Raises:
        InputError: the file is damaged, or its weights are of another table of widths.
    """
    return _OpenedNetwork(weights, precision).method()


def computes_in(precision: str) -> bool:
    """Check for native products in a format, or `auto`."""
    return precision == "auto" or is_native(getattr(torch, precision), _CPU)


def learned_scenes(weights: Path) -> list[str]:
    """The training scenes of a network.

    Raises:
        InputError: the file is damaged.
    """
    return load_tensors(weights)[1]["scenes"]


class _OpenedNetwork:
    """A network, loaded once for all frames."""

    def __init__(self, weights: Path, precision: str):
        self._weights = weights
        network, self._header = load_screen_network(weights)
        self._rays = self._header.get("rays", 0)
        self._shape = light_shape(self._header.get("light"))
        self._network = network.for_inference().in_format(choose_dtype(precision, _CPU))

    def method(self) -> Method:
        bytes_held = sum(w.numel() * w.element_size() for w in self._network.parameters())
        return Method(
            self._of_frame,
            # Stored buffers hold no rays.
            of_buffers=None if self._rays else self._of_buffers,
            by_rays=self._rays > 0,
            texel_floats=0 if self._rays else 1,
            check_own=self._check_own,
            held=lambda frame: bytes_held,
        )

    def _of_buffers(
        self,
        buffers: Mapping[str, np.ndarray],
        lens: Lens,
        radius: float,
        size: float,
        shape: LightShape,
    ) -> np.ndarray:
        light = self._light(radius, size, shape)
        features = named_features(self._network.features, buffers, lens, light)
        planes = torch.from_numpy(features)[None].contiguous(memory_format=torch.channels_last)
        visibility = self._network.in_bands(planes)
        return visibility[0, 0].float().clamp(0, 1).numpy()

    def _check_own(self, part: FrameSetPart) -> None:
        """Check a user's own frames for channels, unit and size."""
        about, needed = part.about, buffers_of(self._network.features)
        if lacking := [name for name in needed if name not in about["channels"]]:
            bases = [name for name in lacking if name in LIT]
            what = "base shadow" if bases == lacking else "channel"
            raise InputError(
                f"{part.source}: has no {what} {', '.join(lacking)}, which {self._weights} needs; "
                f"it has {', '.join(about['channels'])}"
            )
        unit, own = self._header["radius_unit"], about.get("radius_unit")
        if own not in (None, unit):
            raise InputError(
                f"{part.source}: its light's radii are in {own}, but {self._weights} was trained with "
                f"radii in {unit}, up to {max(self._header['radii']):g}. Give them in {unit}."
            )
        reach = self._network.reach
        if min(about["width"], about["height"]) < reach:
            raise InputError(
                f"{part.source}: is {about['width']} × {about['height']}, smaller than the kernels of "
                f"{self._weights}, {reach} × {reach}"
            )

    def _of_frame(self, frame: SoftFrame, radius: float) -> np.ndarray:
        """The same from points and light map, buffers included in time."""
        surface = frame.surface
        needed = [name for name in buffers_of(self._network.features) if name not in TRACED]
        buffers = channel_images(needed, frame)
        if self._rays:
            buffers |= zip(TRACED, traced_images(frame, radius, samples=self._rays))
        lens = lens_of(surface.camera, surface.width, surface.height)
        visible = self._of_buffers(buffers, lens, radius, frame.scene.size, frame.shape)
        return visible.ravel()[surface.pixel]

    def _light(self, radius: float, size: float, shape: LightShape) -> LightSize:
        """The light's size as input: step 4 at the largest trained."""
        unit, trained_on = self._header["radius_unit"], max(self._header["radii"])
        largest = self._shape.radius_of(trained_on, unit, size)
        if radius > largest * (1 + 1e-6):
            given = radius / self._shape.radius_of(1.0, unit, size)
            raise InputError(
                f"{self._weights}: trained on lights of up to {trained_on:g} {unit.replace('_', ' ')}, "
                f"and these frames have one of {given:g}. Train it on a frame set with such a light in "
                "`radii`."
            )
        return light_size(radius, largest, size, shape.AWAY)
