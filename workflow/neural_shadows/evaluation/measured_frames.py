"""Frames of a frame set under an area light."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from importlib import import_module
from pathlib import Path

import numpy as np

from neural_shadows.errors import InputError
from neural_shadows.evaluation.answers import name_of
from neural_shadows.evaluation.frame import Inputs
from neural_shadows.evaluation.method import Constants, Method, visibility
from neural_shadows.evaluation.registry import frame_method, is_network
from neural_shadows.files.arrays import open_array
from neural_shadows.frames.buffers import LIT
from neural_shadows.frames.draw_settings import light_map_of
from neural_shadows.frames.frame_set import FrameSetPart, check_values
from neural_shadows.frames.soft_frame import SoftFrame
from neural_shadows.frames.soft_scene import SoftScene
from neural_shadows.metrics.metric import Pixels
from neural_shadows.rendering.surface import see_surface

ERRORS = ("mse",)
# Imported by the methods that need them alone: see `registry`.
_FIELDS = "neural_shadows.evaluation.method_parts.scene_fields"
_NETWORK = "neural_shadows.evaluation.screen_network_method"


@dataclass(frozen=True, eq=False)
class MeasuredFrame:
    """One frame of a part; images are (height, width)."""

    part: FrameSetPart
    number: int
    opened: SoftScene | None  # None of a user's own frames
    blocks: np.ndarray | None = None  # (2, height, width), of `measure_frames`

    @property
    def path(self) -> Path:
        """Its part's file."""
        return self.part.frames_json

    @property
    def scene_name(self) -> str:
        """The name of its scene."""
        return self.path.parent.name

    @property
    def middle(self) -> int:
        """The middle radius, counted from 0."""
        return len(self.part.radii) // 2

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
        light_map = light_map_of(
            about["light_map"], self.scene, setting.centre, shape=self.part.shape
        )
        return SoftFrame(scene, surface, setting.centre, light_map, self.number, self.part.shape)

    @cached_property
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

    @cached_property
    def pixels(self) -> Pixels:
        """Its masks in metrics."""
        hard = self.target[0] if self.part.radii[0] == 0 else None
        return Pixels(self.valid, hard, self.off_edges)

    @property
    def judged(self) -> np.ndarray:
        """Valid pixels by whose errors constants are chosen, bool: off edges where these are known."""
        return self.valid if self.off_edges is None else self.off_edges

    def picture(self, channel: str) -> np.ndarray:
        """One of its buffers, (height, width) float32.

        Raises:
            InputError: a user's own part does not have it.
        """
        return self.part.image(self.number, channel)

    def answered(self, method: Method, radius: float, constants: Constants) -> np.ndarray:
        """The method's visibility of a light, float32; 1 without a surface."""
        if method.of_buffers is not None:
            part = self.part
            if self.opened is None and method.check_own is not None:
                method.check_own(part)
            buffers = {name: self.picture(name) for name in part.about["channels"]}
            lens = part.lens(self.number)
            visible = method.of_buffers(buffers, lens, radius, part.about["size"], part.shape)
            return np.where(self.picture("z") > 0, visible, np.float32(1))
        if method.channel is not None:
            return self.picture(method.channel)
        if method.constant is not None:
            surfaces, lit = self.picture("z") > 0, self.picture("c_e") > 0
            return np.where(surfaces, np.float32(method.constant) * lit, np.float32(1))
        return self.frame.surface.image(visibility(method, self.frame, radius, constants), 1.0)

    def visibilities(self, method: Method, constants: Sequence[Constants]) -> Iterator[np.ndarray]:
        """The method's image by radius, evaluated once for equal ones."""
        for k, radius in enumerate(self.part.radii):
            if method.changes_at(constants, k):
                image = self.answered(method, radius, constants[k])
            yield image

    def errors_of(
        self, method: Method, tried: Sequence[Sequence[Constants]]
    ) -> tuple[list[np.ndarray], float]:
        """Squared errors off edges by radius (settings, 1), and the pixels."""
        target, mask = self.target, self.judged
        squares = [np.zeros((len(settings), 1)) for settings in tried]
        by_constants: dict[str, np.ndarray] = {}  # of a method independent of the radius
        for k, settings in enumerate(tried):
            for number, constants in enumerate(settings):
                image = by_constants.get(str(constants))
                if image is None:
                    image = self.answered(method, self.part.radii[k], constants)
                if not method.of_radius:
                    by_constants[str(constants)] = image
                squares[k][number] = np.square(image - target[k])[mask].sum()
        return squares, mask.sum()

    def key(self, radius: int) -> dict[str, str | int]:
        """Columns of its metrics."""
        place = {"scene": self.scene_name, "part": self.path.stem}
        return place | {"frame": self.number, "radius": radius}

    def stored(self, visibility: np.ndarray, radius: int) -> dict[str, np.ndarray]:
        """The images of a part's first frame."""
        return {name_of(self.path, radius): visibility} if self.number == 0 else {}


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


def count_frames(paths: Sequence[Path]) -> int:
    """Frames of parts."""
    return sum(len(FrameSetPart(path)) for path in paths)


def count_radii(path: Path) -> int:
    """Radii of a part's light."""
    return len(FrameSetPart(path).radii)


def open_frames(inputs: Inputs) -> Iterator[MeasuredFrame]:
    """Frames of parts, then of sequences.

    Each scene is opened once.

    Raises:
        InputError: an input file cannot be read.
    """
    frames = measured_frames([*inputs.frames, *inputs.sequences], inputs.meshes)
    if inputs.occluders is None:
        yield from frames
        return
    occluders = open_array(inputs.occluders, (None, 2, None, None), np.float16)
    for number, frame in enumerate(frames):
        yield replace(frame, blocks=occluders[number]) if number < len(occluders) else frame


def open_methods(key: str, inputs: Inputs) -> Callable[[str], Method | None]:
    """The method of a key, by scene.

    Of a network for each scene (`Inputs.by_scene`) the one trained on it, else None. None for all
    scenes where the CPU would have to emulate the network's number format.

    Raises:
        InputError: a file of weights or fields cannot be read.
    """
    if frame_method(key).fields:
        import_module(_FIELDS).take_stored(inputs.fields)
    if not is_network(key):
        return lambda scene: frame_method(key)
    network = import_module(_NETWORK)
    if not network.computes_in(inputs.precision):
        return lambda scene: None
    if not inputs.by_scene:
        (weights,) = inputs.weights
        method = network.screen_method(weights, inputs.precision)
        return lambda scene: method
    return {
        scene: network.screen_method(path, inputs.precision)
        for path in inputs.weights
        for scene in network.learned_scenes(path)
    }.get
