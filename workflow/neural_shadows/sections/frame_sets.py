"""`frame_sets`: views under a sun, and frames with exact soft shadows."""

from typing import Annotated, Any, Literal

from pydantic import Discriminator, Field, Tag, model_validator

from neural_shadows.rendering.light_shape import SPHERE
from neural_shadows.sections.own_frames import OwnFrames, own_parts
from neural_shadows.sections.views import Views
from neural_shadows.settings.base import (
    EntryKind,
    Model,
    Name,
    PowerOfTwo,
    by_kind,
    has_key,
    name_in,
)
from neural_shadows.settings.kinds import kinds, union
from neural_shadows.settings.records import RadiusUnit

_SHAPES = "rendering/light_shapes"
Pixels = Annotated[int, Field(ge=16, le=16384)]
Share = Annotated[float, Field(ge=0, le=0.1)]


class PerspectiveMap(Model):
    """One perspective map, as in Neural Shadow Mapping."""

    kind: Literal["perspective"] = Field(description="`perspective`")
    fov: float = Field(120, ge=10, le=150, description="field of view of both sides, degrees")
    resolution: PowerOfTwo = Field(ge=16, le=8192, description="texels along a side")


class CubeMap(Model):
    """Six cube faces, as in Kernel Predicting Neural Shadow Maps."""

    kind: Literal["cube"] = Field(description="`cube`")
    resolution: PowerOfTwo = Field(ge=16, le=8192, description="texels along a side of a face")


class WholeFrame(Model):
    """Size of the whole frame around a window."""

    width: Pixels = Field(description="pixels")
    height: Pixels = Field(description="pixels")


class PerturbedByShares(Model):
    """Perturbed versions of each training frame, for temporal losses."""

    count: int = Field(0, ge=0, le=8, description="perturbed frames for each training frame")
    light: Share = Field(0.007, description="largest shift of the light per axis, in scene sizes")
    eye: Share = Field(0.0013, description="largest shift of the camera per axis, in scene sizes")
    turn_deg: float = Field(0.0, ge=0, le=10, description="largest view rotation per axis, degrees")


class PerturbedByTexels(Model):
    """Perturbed frames with shifts measured in texels and pixels."""

    count: int = Field(0, ge=0, le=8, description="perturbed frames for each training frame")
    light_texels: float = Field(ge=0, le=100, description="largest shift of the light, texels")
    light_radii: float = Field(
        0.0, ge=0, le=1, description="added to it, in radii of the largest light"
    )
    eye_pixels: float = Field(0.0, ge=0, le=10, description="largest shift of the camera, pixels")


Perturbed = Annotated[
    Annotated[PerturbedByShares, Tag("Shares")] | Annotated[PerturbedByTexels, Tag("Texels")],
    Discriminator(lambda value: "Texels" if has_key(value, "light_texels") else "Shares"),
]


class Samples(Model):
    """Shadow rays per place in a pixel and ring between radii."""

    train: int = Field(4, ge=1, le=1024, description="of training and validation frames")
    measured: int = Field(16, ge=1, le=1024, description="of test frames and sequences")


class RenderedFrames(Model):
    """Frames of scenes under an area light, with buffers and exact soft shadows."""

    scenes: list[name_in("scenes")] = Field(
        min_length=1, description="names in `scenes`, for training, validation and test"
    )
    unseen: list[name_in("scenes")] = Field([], description="names in `scenes`, for tests alone")
    width: Pixels = Field(description="pixels of a frame")
    height: Pixels = Field(description="pixels of a frame")
    train_width: Pixels | None = Field(None, description="pixels of a training frame, if different")
    fov: float = Field(55, ge=5, le=120, description="vertical, of the whole frame, degrees")
    of: WholeFrame | None = Field(
        None, description="size of the whole frame, if frames are windows of a larger one"
    )
    light_map: by_kind("kind", PerspectiveMap, CubeMap) = Field(
        description="the light's shadow map"
    )
    light: union(_SHAPES, default="sphere", key="shape") = Field(
        kinds(_SHAPES)["sphere"].Settings(shape="sphere"), description="shape of the light"
    )
    radii: list[Annotated[float, Field(ge=0, le=10)]] = Field(
        min_length=1,
        max_length=16,
        description="radii of the light, ascending; 0 is a point, or a sun without extent",
    )
    radius_unit: RadiusUnit = Field(
        default_factory=lambda frames: frames.get("light", SPHERE).RADIUS_UNITS[0],
        description="unit of `radii`: `metres`, or `scene_sizes`, the longest side of the scene's bounding "
        "box; of a sun `degrees`",
    )
    train: int = Field(0, ge=0, le=100_000, description="training frames of each scene")
    # Constants by four frames of each of five scenes changed errors of 14 methods on test frames by −8 to +5 %,
    # 46 of 56 not at all, and searches took twice the time.
    validation: int = Field(2, ge=1, le=10_000, description="validation frames of each scene")
    tuned_also_on: Name | None = Field(
        None,
        description="another frame set under the same lights, of each of whose scenes the first file of "
        "validation frames (`shard`; of `new_layouts` one layout) chooses the constants of methods, too",
    )
    test: int = Field(2, ge=1, le=10_000, description="test frames of each scene")
    unseen_test: int | None = Field(
        None,
        ge=1,
        le=10_000,
        description="test frames of each scene in `unseen`; default: as `test`",
    )
    sequence: int = Field(0, ge=0, le=1000, description="frames per sequence; 0 for none")
    moving: list[name_in("scenes")] | None = Field(
        None,
        min_length=1,
        description="scenes of `scenes` and `unseen` with measured sequences; without it the first",
    )
    shard: int = Field(16, ge=1, le=10_000, description="frames per file, and per job")
    twins: Perturbed = Field(
        PerturbedByShares(), description="perturbed training frames, for temporal losses"
    )
    samples: Samples = Field(Samples(), description="shadow rays of the exact soft shadows")
    blur: float = Field(0.0, ge=0, le=5, description="σ of a blur of the soft shadows, pixels")
    rays: Literal[0, 1, 2, 3, 4, 6, 8, 16] = Field(
        0,
        description="rays a pixel of training and validation frames, for networks with the feature `base_rays`",
    )

    @model_validator(mode="after")
    def _check(self):
        for key, value, allowed in (
            ("radius_unit", self.radius_unit, self.light.RADIUS_UNITS),
            ("light_map.kind", self.light_map.kind, self.light.MAPS),
        ):
            if value not in allowed:
                raise ValueError(
                    f"{key}: {value!r} does not suit a light of the shape {self.light.shape}. Use "
                    f"{' or '.join(allowed)}"
                )
        if self.radii != sorted(set(self.radii)):
            raise ValueError(f"radii = {self.radii}: must be ascending, without repetition")
        if both := set(self.scenes) & set(self.unseen):
            raise ValueError(f"unseen: {', '.join(sorted(both))} is also in `scenes`. List it once")
        if self.of and (self.of.width < self.width or self.of.height < self.height):
            raise ValueError(
                f"of = {self.of.width} × {self.of.height}: must be at least the window, "
                f"{self.width} × {self.height}"
            )
        moving = self.moving or ()
        if moving and not self.sequence:
            raise ValueError(
                "moving: needs a `sequence` of 2 frames or more. Set it, or leave `moving` out"
            )
        if len(set(moving)) < len(moving):
            raise ValueError(f"moving: {', '.join(moving)}: a scene is listed twice. List it once")
        if others := set(moving) - {*self.scenes, *self.unseen}:
            raise ValueError(
                f"moving: {', '.join(sorted(others))}: neither in `scenes` nor in `unseen`. List it there, or "
                "not here"
            )
        if self.sequence == 1:
            raise ValueError(
                "sequence = 1: a sequence needs at least two frames. Set 2 or more, or 0 for none"
            )
        return self


VIEWS = "views"
"""The entry with the thesis's views of meshes under a sun."""


def _is_views(entry: Any) -> bool:
    return any(has_key(entry, key) for key in ("views_per_set", "held_out_views", "batch"))


SOFT = EntryKind("a set of frames under an area light", lambda entry: not _is_views(entry))
FrameSetName = name_in("frame_sets", SOFT)


def _tag(entry: Any) -> str:
    return "Views" if _is_views(entry) else "Own" if has_key(entry, "path") else "Rendered"


FrameSet = Annotated[
    Annotated[Views, Tag("Views")]
    | Annotated[RenderedFrames, Tag("Rendered")]
    | Annotated[OwnFrames, Tag("Own")],
    Discriminator(_tag),
]


def measured_scenes(frames: RenderedFrames | OwnFrames) -> list[Name]:
    """Scenes with test frames."""
    if isinstance(frames, OwnFrames):
        return list(own_parts(frames))
    return [*frames.scenes, *frames.unseen]
