"""Frame sets of the user's own: a folder of a folder for each scene."""

from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field, model_validator

from neural_shadows.frames.engine_channels import CHANNEL_IMAGES, RADII, TARGET_IMAGES
from neural_shadows.settings.base import Model

Folder = Annotated[str, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9_-]*$")]
ImageName = Annotated[str, Field(pattern=r"^[^/]+:[^:/]+$")]
Channel = Literal[tuple(CHANNEL_IMAGES)]


class EngineFrames(Model):
    """How an engine's frames are written: a folder each, of EXR files or with one npz file."""

    sizes: dict[Folder, Annotated[float, Field(gt=0)]] = Field(
        min_length=1,
        description="by its folder each scene's size, the longest side of its box, in the unit of the "
        "frames' distances",
    )
    fov: float = Field(55, ge=5, le=150, description="vertical, in degrees")
    radii: list[Annotated[float, Field(ge=0)]] = Field(
        RADII, min_length=1, max_length=8, description="of the lights to answer for; 0 is a point"
    )
    radius_unit: Literal["metres", "scene_sizes"] = Field(
        "scene_sizes", description="as the network was trained; the frames are in metres then, too"
    )
    channels: dict[Channel, ImageName | None] = Field(
        {}, description="where images lie, `FILE:CHANNEL`, if elsewhere; null for none"
    )
    targets: list[ImageName] = Field(
        TARGET_IMAGES, description="exact shadows, `FILE:CHANNEL`, one of each radius; [] for none"
    )

    @model_validator(mode="after")
    def _check(self):
        if self.radii != sorted(set(self.radii)):
            raise ValueError(f"radii = {self.radii}: must grow from each to the next")
        if self.targets and len(self.targets) != len(self.radii):
            raise ValueError(
                f"targets: {len(self.targets)} images for {len(self.radii)} radii; name one of each, or "
                "[] for none"
            )
        return self


class OwnFrames(Model):
    """Frames of the user's own, from an engine."""

    path: str = Field(
        min_length=1,
        description="a folder of folders, one a scene, with the files that results/README.md tells",
    )
    engine: EngineFrames | None = Field(
        None, description="of frames as the engine writes them, how; without it they are arrays"
    )


def own_parts(frames: OwnFrames) -> dict[str, list[str]]:
    """The parts of the scenes with test frames in a folder of a user's own, by scene: `test_000` of
    `test_000.json`. Of an engine's frames each is a part.
    """
    if frames.engine is not None:
        return {scene: [*parts] for scene, parts in _engine_files(frames).items()}
    scenes: dict[str, list[str]] = {}
    for file in sorted(Path(frames.path).glob("*/*_[0-9]*.json")):
        scenes.setdefault(file.parent.name, []).append(file.stem)
    return {
        scene: parts
        for scene, parts in scenes.items()
        if any(part.startswith("test_") for part in parts)
    }


def _engine_files(frames: OwnFrames) -> dict[str, dict[str, list[str]]]:
    """The files of an engine's frames by scene and part, in the order of their folders' names."""
    found: dict[str, dict[str, list[str]]] = {}
    for scene in frames.engine.sizes:
        files: dict[Path, list[str]] = {}
        for file in sorted(Path(frames.path, scene).glob("*/*")):
            if file.suffix in (".exr", ".npz"):
                files.setdefault(file.parent, []).append(str(file))
        if files:
            found[scene] = {f"test_{k:03}": one for k, one in enumerate(files.values())}
    return found


def without_frames(frames: OwnFrames) -> str | None:
    """What a folder of a user's own lacks, in words; None if nothing."""
    if frames.engine is None:
        return None if own_parts(frames) else "no SCENE/test_000.json in it"
    lacking = [scene for scene in frames.engine.sizes if scene not in own_parts(frames)]
    return f"no frame in {lacking[0]}/, such as {lacking[0]}/FRAME/z.exr" if lacking else None


def own_settings(frames: OwnFrames) -> dict[str, Any]:
    """Such a frame set as rules look it up; of an engine's with the `files` of each part."""
    found = {"path": frames.path, "parts": own_parts(frames), "engine": None}
    if frames.engine is None:
        return found
    engine = frames.engine.model_dump() | {"files": _engine_files(frames)}
    engine["channels"] = CHANNEL_IMAGES | frames.engine.channels
    return found | {"engine": engine}
