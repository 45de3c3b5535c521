"""Frames of a frame set, opened for methods and metrics."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from neural_shadows.errors import InputError
from neural_shadows.evaluation.soft_method import SoftMethod, visibility
from neural_shadows.frames.buffers import LIT
from neural_shadows.frames.draw_settings import light_map_of
from neural_shadows.frames.frame_set import FrameSetPart, check_values
from neural_shadows.frames.soft_frame import SoftFrame
from neural_shadows.frames.soft_scene import SoftScene
from neural_shadows.rendering.surface import see_surface


@dataclass(frozen=True, eq=False)
class MeasuredFrame:
    """One frame of a part; images are (height, width)."""

    part: FrameSetPart
    number: int
    opened: SoftScene | None  # None of a user's own frames

    @property
    def scene_name(self) -> str:
        """The name of its scene."""
        return self.part.frames_json.parent.name

    @property
    def scene(self) -> SoftScene:
        """The scene of the frame.

        Raises:
            InputError: a user's own frame has none.
        """
        if self.opened is None:
            raise InputError(
                f"{self.part.source}: has no 'scene' to look at. Evaluate only methods from its "
                f"buffers: {', '.join(f'base_{name}' for name in LIT)}, networks"
            )
        return self.opened

    @cached_property
    def frame(self) -> SoftFrame:
        """Input of methods: scene, surface, light and map."""
        about, setting = self.part.about, self.part.setting(self.number)
        scene = self.scene.moved(setting.motion)
        surface = see_surface(scene, setting.camera, about["width"], about["height"])
        light_map = light_map_of(about["light_map"], self.scene, setting.centre)
        return SoftFrame(scene, surface, setting.centre, light_map, self.number)

    @property
    def target(self) -> np.ndarray:
        """The exact soft shadow of each radius, (radii, height, width) float32.

        Raises:
            InputError: an engine's frame without one.
        """
        if not self.part.has_targets:
            raise InputError(
                f"{self.part.source}: has no exact shadow to measure against. Without one a frame has "
                "images (reports/answers/) but is in no table."
            )
        return self.part.targets[self.number].astype(np.float32)

    @property
    def valid(self) -> np.ndarray:
        """Mask of pixels in metrics, bool."""
        return self.part.valid[self.number, 0]

    @property
    def off_edges(self) -> np.ndarray | None:
        """Valid pixels off the geometry's edges, bool; None if unknown."""
        edges = self.part.edges
        return None if edges is None else self.valid & ~edges[self.number]

    def picture(self, channel: str) -> np.ndarray:
        """One of its buffers, (height, width) float32.

        Raises:
            InputError: a user's own part does not have it.
        """
        return self.part.image(self.number, channel)

    def answered(
        self, method: SoftMethod, radius: float, constants: Mapping[str, float]
    ) -> np.ndarray:
        """The method's visibility of a light, float32; 1 without a surface."""
        if method.of_buffers is not None:
            part = self.part
            if self.opened is None and method.check_own is not None:
                method.check_own(part)
            buffers = {name: self.picture(name) for name in part.about["channels"]}
            lens = part.lens(self.number)
            visible = method.of_buffers(buffers, lens, radius, part.about["size"])
            return np.where(self.picture("z") > 0, visible, np.float32(1))
        if method.channel is not None:
            return self.picture(method.channel)
        if method.constant is not None:
            surfaces, lit = self.picture("z") > 0, self.picture("c_e") > 0
            return np.where(surfaces, np.float32(method.constant) * lit, np.float32(1))
        return self.frame.surface.image(visibility(method, self.frame, radius, constants), 1.0)


def measured_frames(parts: Sequence[Path], meshes: Sequence[Path]) -> Iterator[MeasuredFrame]:
    """All frames of some parts, in order.

    Args:
        meshes: prepared, of all inserted objects, in folders of their names.

    Raises:
        InputError: a part or a mesh is damaged, or a user's own part has impossible values.
    """
    mesh_paths, scenes = {path.parent.name: path for path in meshes}, {"": None}
    for path in parts:
        part = FrameSetPart(path)
        scene = part.about.get("scene")
        if scene is None:
            check_values(part)
        key = str(scene or "")
        if key not in scenes:
            scenes[key] = SoftScene(scene, [mesh_paths[name] for name in scene["inserted"]])
        for number in range(len(part)):
            yield MeasuredFrame(part, number, scenes[key])
