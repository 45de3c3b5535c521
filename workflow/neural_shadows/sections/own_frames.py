"""Frame sets of the user: one folder per scene."""

from collections.abc import Iterable
from pathlib import Path
from typing import Annotated, Any, Literal
from zipfile import BadZipFile, ZipFile

from pydantic import Field, model_validator

from neural_shadows.files.whole_files import read_json
from neural_shadows.frames.engine_channels import CHANNEL_IMAGES, RADII, TARGET_IMAGES
from neural_shadows.settings.base import Model

Folder = Annotated[str, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9_-]*$")]
ImageName = Annotated[str, Field(pattern=r"^[^/]+:[^:/]+$")]
Channel = Literal[tuple(CHANNEL_IMAGES)]


class EngineFrames(Model):
    """Engine frames: a folder each, with EXR files or one npz."""

    sizes: dict[Folder, Annotated[float, Field(gt=0)]] = Field(
        min_length=1,
        description="size of each scene by folder name: the longest side of its bounding box, in the "
        "unit of the frames' distances",
    )
    fov: float = Field(55, ge=5, le=150, description="vertical field of view, degrees")
    radii: list[Annotated[float, Field(ge=0)]] = Field(
        RADII,
        min_length=1,
        max_length=8,
        description="radii of the lights to evaluate, ascending; 0 is a point",
    )
    radius_unit: Literal["metres", "scene_sizes"] = Field(
        "scene_sizes",
        description="unit of `radii`, the same as in the network's training; with `metres` frames must be in metres",
    )
    prefix: str = Field(
        "", description="begins the file names of `channels` and `targets` by default, as `Mogwai.`"
    )
    channels: dict[Channel, ImageName | None] = Field(
        {}, description="images with other names than the default, as `FILE:CHANNEL`; null for none"
    )
    targets: list[ImageName] = Field(
        default_factory=lambda frames: [frames.get("prefix", "") + name for name in TARGET_IMAGES],
        description="images of exact shadows, as `FILE:CHANNEL`, one per radius; default: the six of Hu "
        "et al. 2025's frames; [] for none",
    )

    @model_validator(mode="after")
    def _check(self):
        if self.radii != sorted(set(self.radii)):
            raise ValueError(f"radii = {self.radii}: must be ascending, without repetition")
        if self.targets and len(self.targets) != len(self.radii):
            raise ValueError(
                f"targets: {len(self.targets)} images for {len(self.radii)} radii. Name one per radius, or "
                "[] for none"
            )
        return self


class OwnFrames(Model):
    """Frames of the user."""

    path: str = Field(
        min_length=1,
        description="folder with one subfolder per scene; results/README.md describes the files",
    )
    engine: EngineFrames | None = Field(
        None,
        description="description of frames in an engine's own files; without it frames are arrays",
    )


def own_parts(frames: OwnFrames) -> dict[str, list[str]]:
    """Parts of scenes with test frames, by scene.

    `test_000` for `test_000.json`; each frame of an engine is a part.
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
    """Files of an engine's frames by scene and part, sorted by folder."""
    scenes: dict[str, dict[str, list[str]]] = {}
    for scene in frames.engine.sizes:
        files: dict[Path, list[str]] = {}
        for file in sorted(Path(frames.path, scene).glob("*/*")):
            if file.suffix in (".exr", ".npz"):
                files.setdefault(file.parent, []).append(str(file))
        if files:
            scenes[scene] = {f"test_{k:03}": paths for k, paths in enumerate(files.values())}
    return scenes


def without_frames(frames: OwnFrames) -> str | None:
    """First missing file of a user's folder, in words, or None."""
    if frames.engine is None:
        return None if own_parts(frames) else "no SCENE/test_000.json in it"
    empty = [scene for scene in frames.engine.sizes if scene not in own_parts(frames)]
    return f"no frame in {empty[0]}/, as FRAME/FILE.exr or .npz" if empty else None


def lacking(frames: OwnFrames, buffers: Iterable[str]) -> str | None:
    """First missing channel of buffers in words, or None.

    An EXR file's own channels are read with the frame.

    Args:
        buffers: names of `frames.buffers`.
    """
    if frames.engine is None:
        for scene, parts in own_parts(frames).items():
            for file in (Path(frames.path, scene, f"{part}.json") for part in parts):
                channels = read_json(file).get("channels", [])
                if absent := [buffer for buffer in buffers if buffer not in channels]:
                    return f"{file} has no channel {absent[0]}. Write it"
        return None
    images = _images(frames.engine)
    for channel in ("z_b" if buffer == "gap" else buffer for buffer in buffers):
        key = f"`engine.channels.{channel}`"
        if (image := images[channel]) is None:
            return f"{key} names no image. Name the frames' image of it as FILE:CHANNEL"
        name = image.rsplit(":", 1)[0]
        for paths in (p for parts in _engine_files(frames).values() for p in parts.values()):
            if name not in _image_files(paths):
                where = paths[0] if paths[0].endswith(".npz") else Path(paths[0]).parent
                return f"{where} has no {name}. Write it there, or name another image in {key}"
    return None


def _image_files(paths: list[str]) -> set[str]:
    """Names of a frame's EXR files, or of its archive's arrays."""
    archives = [path for path in paths if path.endswith(".npz")]
    if not archives:
        return {Path(path).stem for path in paths}
    try:
        with ZipFile(archives[0]) as archive:
            return {name.removesuffix(".npy") for name in archive.namelist()}
    except (OSError, BadZipFile):  # the import says so
        return set()


def _images(engine: EngineFrames) -> dict[str, str | None]:
    """Image of each channel."""
    names = {name: image and engine.prefix + image for name, image in CHANNEL_IMAGES.items()}
    return names | engine.channels


def own_settings(frames: OwnFrames) -> dict[str, Any]:
    """A user's frame set as rules use it; an engine's with `files`."""
    settings = {"path": frames.path, "parts": own_parts(frames), "engine": None}
    if frames.engine is None:
        return settings
    engine = frames.engine.model_dump() | {"files": _engine_files(frames)}
    engine["channels"] = _images(frames.engine)
    return settings | {"engine": engine}
