"""A shadow method: its answers, constants, label and look."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from neural_shadows.errors import InputError
from neural_shadows.evaluation.look import Look

if TYPE_CHECKING:  # the graph needs metadata alone
    from neural_shadows.frames.frame_set import FrameSetPart
    from neural_shadows.frames.soft_frame import SoftFrame
    from neural_shadows.rendering.gbuffer import GBuffer
    from neural_shadows.rendering.reprojection import Reprojection
    from neural_shadows.scenes.scene import Scene

Constants = Mapping[str, float]
# Of a depth bias, in sphere radii, the visibility of the light at a view's n surface points, (n,)
# float32; 0 where a surface is turned from the light.
OfBias = Callable[[float], np.ndarray]
ShadowMethod = Callable[["GBuffer"], OfBias]

# Candidates of `depth_bias`, in sphere radii, three an octave from half the shading offset: down to
# −1/60, none, up to 1/8. A depth that is slightly short causes self-shadowing: a bias removes it, and
# light leaks where it is too large. A distance field, right on average, may need a negative one.
_OCTAVES = np.round(0.0005 * 2 ** (np.arange(25) / 3), 5)
BIASES = tuple(float(b) for b in (*-_OCTAVES[15::-1], 0.0, *_OCTAVES))
ROUNDS_OF_HISTORY = 2  # in which the constants of a history are chosen, one after the other


@dataclass(frozen=True)
class Method:
    """A method, or one for each size N, as FAMILY_N.

    It answers a view of a scene in its unit sphere under a sun if it has `sun` or `constant`; a frame
    under an area light if it has `answer`, `of_buffers`, `channel` or `constant`.

    Args:
        answer: of a frame and the light's radius in the scene's unit, visibilities (n,) float32 in
            [0, 1]. Takes the constants as keyword arguments.
        constants: the candidates of each, for frames; those of the least error on validation frames
            are used, one set for each radius. A view has the depth bias alone, and of a network `push`.
        label: its name in tables and figures; `{}` stands for N.
        sun: of a view's `GBuffer` and its `Scene`, a function of the depth bias (see `OfBias`), so
            that it runs once for all biases; `whole_map`, render whole maps as a renderer does, not
            the texels of receivers alone; `size`, N, if it has one.
        sizes: allowed N; empty of a method without one.
        stored_bytes: of a size, in a file as in memory; None if it stores nothing.
        exact: the reference itself.
        of_history: the candidates of further constants of `sequence`, searched one after the other on sequences,
            the others being those of the middle radius.
        joint: constants are searched jointly, and of equal errors the smallest are chosen; else one
            after another, and the first. rounds: of those searches, in which all are chosen anew.
        tuned_as: key of the method with its constants, if not its own.
        fields: needs fields fitted to a scene's objects.
        package: a required optional package.
        null: a null predictor, which a network must beat.
        look: if not its family's.
        sequence: of the radius and the constants, if it has a history: a function of the next frame
            of a sequence and its reprojection to the one before, None at first, visibilities (n,).
        texel_floats: float32 numbers in a texel of its light map; 0 for none.
        held: of a frame, bytes in memory of the scene's data beside the triangles.
        of_radius: visibility depends on the light's radius.
        by_rays: sends rays to the light's points. All others are dark where a surface faces away
            from the light's centre, though it may see a part of a large light.
        of_buffers: of a frame's buffers by name (height, width), the camera's `Lens`, the radius, the
            scene's size and the light's shape, visibilities (height, width) float32, if it needs
            buffers alone; `answer` then computes the buffers, for timing.
        check_own: of a part of a user's own frames, raises an InputError for unsuitable ones.
        channel: the frame's buffer with its visibility, if stored.
        constant: the visibility of all surfaces facing the light.
        last: a filter of a surface and its visibilities (n,), after all else, so that in screen space the
            border of surfaces that face away is filtered, too. of_last: its constants among all, whose first
            candidates leave visibilities as they are.
        resolution: texels of a side of the light's map, if not the frame set's.
    """

    answer: Callable[..., np.ndarray] | None = None
    constants: Mapping[str, Sequence[float]] = field(default_factory=dict)
    label: str = ""
    sun: Callable[..., OfBias] | None = None
    sizes: range = range(0)
    stored_bytes: Callable[[int], int] | None = None
    of_history: Mapping[str, Sequence[float]] = field(default_factory=dict)
    exact: bool = False
    joint: bool = False
    rounds: int = 1
    tuned_as: str | None = None
    fields: bool = False
    package: str | None = None
    null: bool = False
    look: Look | None = None
    sequence: "Callable[..., Callable[[SoftFrame, Reprojection | None], np.ndarray]] | None" = None
    texel_floats: int = 1
    held: "Callable[[SoftFrame], int] | None" = None
    of_radius: bool = True
    by_rays: bool = False
    of_buffers: Callable[..., np.ndarray] | None = None
    check_own: "Callable[[FrameSetPart], None] | None" = None
    channel: str | None = None
    constant: float | None = None
    last: "Callable[..., np.ndarray] | None" = None
    of_last: tuple[str, ...] = ()
    resolution: int | None = None

    def __post_init__(self):
        for name, values in (*self.constants.items(), *self.of_history.items()):
            if not isinstance(values, Sequence) or not values:
                raise ValueError(
                    f"{self.label}: the candidates of {name} are {values!r}. List one or more"
                )

    @property
    def answers_views(self) -> bool:
        """Check for answers to views under a sun."""
        return self.sun is not None or self.constant is not None

    @property
    def answers_frames(self) -> bool:
        """Check for answers to frames under an area light."""
        inputs = self.answer, self.of_buffers, self.channel, self.constant
        return any(each is not None for each in inputs)

    @property
    def needs_scene(self) -> bool:
        """Check for the need of more than a frame's buffers."""
        return self.answer is not None and self.of_buffers is None

    def of_view(self, frame: "GBuffer", scene: "Scene | None", **settings) -> OfBias:
        """Visibility of a view at any depth bias; settings: of `sun`."""
        if self.constant is None:
            return self.sun(frame, scene, **settings)
        return whatever_bias(frame.visibility(np.full(len(frame.p), self.constant)))

    def changes_at(self, constants: Sequence[Constants], radius: int) -> bool:
        """Check for a change of visibility from the radius before.

        Args:
            constants: by radius. radius: counted from 0.
        """
        return radius == 0 or self.of_radius or constants[radius] != constants[radius - 1]


def visibility(
    method: Method, frame: "SoftFrame", radius: float, constants: Constants
) -> np.ndarray:
    """A method's visibility at a frame's points, (n,) float32.

    Raises:
        InputError: the method answers another number of values.
    """
    if method.last is None:
        return _unfiltered(method, frame, radius, constants)
    own = {name: value for name, value in constants.items() if name not in method.of_last}
    key = method.answer, method.resolution, radius, *own.items()
    if key not in frame.kept:
        frame.kept.clear()
        frame.kept[key] = _unfiltered(method, frame, radius, own)
    of_last = {name: constants[name] for name in method.of_last}
    return method.last(frame.surface, frame.kept[key], **of_last)


def _unfiltered(
    method: Method, frame: "SoftFrame", radius: float, constants: Constants
) -> np.ndarray:
    if method.resolution is not None:
        frame = frame.with_map_of(method.resolution)
    shares = method.answer(frame, radius, **constants)
    if np.shape(shares) != frame.surface.pixel.shape:
        raise InputError(
            f"{method.label}: it answers {np.shape(shares)} numbers. Return one for each of the frame's "
            f"{len(frame.surface.pixel)} surface points, as frame.surface.pixel counts them"
        )
    if method.by_rays or method.of_buffers is not None:
        return shares
    return np.where(frame.cosines > 0, shares, np.float32(0))


def whatever_bias(visibility: np.ndarray) -> OfBias:
    """The same visibility at any depth bias."""
    return lambda depth_bias: visibility


def rays_label(count: int) -> str:
    """`1 ray`, `4 rays`."""
    return f"{count} ray{'s' if count > 1 else ''}"
