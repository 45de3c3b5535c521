"""`frame_sets`: frames with buffers and exact soft shadows, to train on and to measure on."""

from typing import Annotated, Any, Literal

from pydantic import (
    BeforeValidator,
    Discriminator,
    Field,
    Tag,
    ValidationInfo,
    model_validator,
)

from neural_shadows.sections.own_frames import OwnFrames, own_parts
from neural_shadows.settings.base import Model, Name, PowerOfTwo, by_kind, name_in

Pixels = Annotated[int, Field(ge=16, le=16384)]
Share = Annotated[float, Field(ge=0, le=0.1)]


class PerspectiveMap(Model):
    """One picture from the light, as Neural Shadow Mapping has it."""

    kind: Literal["perspective"] = Field(description="`perspective`")
    fov: float = Field(120, ge=10, le=150, description="degrees, of both sides")
    resolution: PowerOfTwo = Field(ge=16, le=8192, description="texels of a side")


class CubeMap(Model):
    """Six pictures all round the light, as Kernel Predicting Neural Shadow Maps has it."""

    kind: Literal["cube"] = Field(description="`cube`")
    resolution: PowerOfTwo = Field(ge=16, le=8192, description="texels of a face's side")


class WholeFrame(Model):
    """The frame that a set's frames are windows of."""

    width: Pixels = Field(description="pixels")
    height: Pixels = Field(description="pixels")


class Twins(Model):
    """Versions of each training frame with light, eye and view a little elsewhere."""

    count: int = Field(0, ge=0, le=8, description="of each frame")
    light: Share = Field(0.007, description="how far each coordinate moves, in scene sizes")
    eye: Share = Field(0.0013, description="likewise of the camera")
    turn_deg: float = Field(0.0, ge=0, le=10, description="how far the view turns about each axis")


class TwinsByTexels(Model):
    """Versions of each training frame with light and eye so far elsewhere that texels change."""

    count: int = Field(0, ge=0, le=8, description="of each frame")
    light_texels: float = Field(ge=0, le=100, description="how far the light moves, in texels")
    light_radii: float = Field(0.0, ge=0, le=1, description="and, of the largest light's radius")
    eye_pixels: float = Field(0.0, ge=0, le=10, description="how far the eye moves, in pixels")


AnyTwins = Annotated[
    Annotated[Twins, Tag("Shares")] | Annotated[TwinsByTexels, Tag("Texels")],
    Discriminator(
        lambda value: (
            "Texels"
            if (isinstance(value, dict) and "light_texels" in value)
            or hasattr(value, "light_texels")
            else "Shares"
        )
    ),
]


class Samples(Model):
    """Rays for each of eight places in a pixel and each ring between two radii."""

    train: int = Field(4, ge=1, le=1024, description="of frames to train on and to choose by")
    measured: int = Field(16, ge=1, le=1024, description="of test frames and of sequences")


def _in_metres(name: Any, info: ValidationInfo) -> Any:
    """A scene's name, but not one of `scenes` alone, whose meshes may have any unit."""
    known, metric = (info.context.get(section) or () for section in ("scenes", "soft_scenes"))
    if isinstance(name, str) and name in known and name not in metric:
        raise ValueError(
            f"{name!r} is in `scenes` and has no metres; let it stand in a scene of `soft_scenes`, "
            f"`inserted: [{name}]`"
        )
    return name


MetricScene = Annotated[name_in("soft_scenes"), BeforeValidator(_in_metres)]


class RenderedFrames(Model):
    """Frames of generated scenes."""

    scenes: list[MetricScene] = Field(min_length=1, description="for training, validation and test")
    unseen: list[MetricScene] = Field([], description="for tests alone")
    width: Pixels = Field(description="pixels of a frame")
    height: Pixels = Field(description="pixels of a frame")
    train_width: Pixels | None = Field(None, description="of training frames, if another")
    fov: float = Field(55, ge=5, le=120, description="vertical, in degrees, of the whole frame")
    of: WholeFrame | None = Field(
        None, description="frames are windows of one of this size; without it they are whole"
    )
    light_map: by_kind("kind", PerspectiveMap, CubeMap) = Field(description="the light's map")
    radii: list[Annotated[float, Field(ge=0, le=10)]] = Field(
        min_length=1, max_length=16, description="of the light; 0 is a point"
    )
    radius_unit: Literal["metres", "scene_sizes"] = Field(
        "metres", description="a scene's size is the longest side of its box"
    )
    train: int = Field(0, ge=0, le=100_000, description="frames of each scene")
    validation: int = Field(2, ge=1, le=10_000, description="frames of each scene")
    test: int = Field(2, ge=1, le=10_000, description="frames of each scene")
    unseen_test: int | None = Field(
        None, ge=1, le=10_000, description="of each of `unseen`, if not as many as `test`"
    )
    sequence: int = Field(
        0, ge=0, le=1000, description="frames of each sequence of the first scene; 0 for none"
    )
    shard: int = Field(16, ge=1, le=10_000, description="frames of a file, and of a job")
    twins: AnyTwins = Field(Twins(), description="versions of training frames")
    samples: Samples = Field(Samples(), description="rays of the exact soft shadows")
    blur: float = Field(0.0, ge=0, le=5, description="σ of the soft shadows' blur, in pixels")

    @model_validator(mode="after")
    def _check(self):
        if self.radii != sorted(set(self.radii)):
            raise ValueError(f"radii = {self.radii}: must grow from each to the next")
        if both := set(self.scenes) & set(self.unseen):
            raise ValueError(f"unseen: {', '.join(sorted(both))} is among `scenes`, too")
        if self.of and (self.of.width < self.width or self.of.height < self.height):
            raise ValueError(
                f"of = {self.of.width} × {self.of.height}: must not be smaller than the window, "
                f"{self.width} × {self.height}"
            )
        if self.sequence == 1:
            raise ValueError("sequence = 1: a sequence has two frames or more; 0 for none")
        return self


FrameSet = Annotated[
    Annotated[RenderedFrames, Tag("Rendered")] | Annotated[OwnFrames, Tag("Own")],
    Discriminator(
        lambda value: (
            "Own"
            if (isinstance(value, dict) and "path" in value) or hasattr(value, "path")
            else "Rendered"
        )
    ),
]


def measured_scenes(frames: RenderedFrames | OwnFrames) -> list[Name]:
    """The scenes of a frame set that methods are measured on."""
    if isinstance(frames, OwnFrames):
        return list(own_parts(frames))
    return [*frames.scenes, *frames.unseen]
