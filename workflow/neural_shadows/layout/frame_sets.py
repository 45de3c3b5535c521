"""Parts of frame sets: files and settings of their jobs."""

from collections.abc import Iterable, Mapping
from typing import Any

from neural_shadows.frames.uses import SEQUENCES
from neural_shadows.layout.layout import Layout
from neural_shadows.layout.parts import part_names

# Settings shared by all frames of a set.
FRAME_KEYS = ("width", "height", "fov", "of", "light_map", "radii", "radius_unit", "twins", "blur")


def frame_settings(layout: Layout, scene: str, frame_set: str, part: str) -> dict[str, Any]:
    """Settings of `render_frames` for a part."""
    settings = layout.entry("frame_sets", frame_set)
    use, number = part.rsplit("_", 1)
    total, shard = _counts(settings, scene, use)
    first, is_training = int(number) * shard, use == "train"
    frames = {key: settings[key] for key in FRAME_KEYS}
    frames["width"] = (settings["train_width"] if is_training else None) or settings["width"]
    return {
        "scene": layout.entry("soft_scenes", scene),
        "name": scene,
        "seed": layout.settings["seed"],
        "frames": frames,
        "use": use,
        "first": first,
        "last": min(first + shard, total),
        # Noise of targets adds equally to all errors: choosing among them needs few rays.
        "samples": settings["samples"]["train" if use in ("train", "validation") else "measured"],
        "twins": settings["twins"]["count"] * is_training,
    }


def _counts(settings: Mapping[str, Any], scene: str, use: str) -> tuple[int, int]:
    """Frames of a scene and use, and frames per part."""
    if use in SEQUENCES:
        return settings["sequence"], max(settings["sequence"], 1)
    total = settings[use]
    if use == "test" and scene in settings["unseen"]:
        total = settings["unseen_test"] or total
    return total, settings["shard"]


def engine_files(layout: Layout, scene: str, frame_set: str, part: str) -> list[str]:
    """Files of an engine's frame."""
    return layout.entry("frame_sets", frame_set)["engine"]["files"][scene][part]


def import_settings(layout: Layout, scene: str, frame_set: str) -> dict[str, Any]:
    """Settings of `import_frame` for an engine's frames."""
    engine = layout.entry("frame_sets", frame_set)["engine"]
    keys = ("fov", "radii", "radius_unit", "channels", "targets")
    return {"size": engine["sizes"][scene], **{key: engine[key] for key in keys}}


def meshes(layout: Layout, scene: str) -> list[str]:
    """Meshes of a scene's inserted objects; none of a user's frames."""
    inserted = layout.settings["soft_scenes"].get(scene, {}).get("inserted", ())
    return [layout.paths.scene("mesh.ply", name) for name in inserted]


def generators(layout: Layout, scenes: Iterable[str]) -> list[str]:
    """Generators of scenes, each once; none of a user's frames."""
    soft = layout.settings["soft_scenes"]
    return sorted({soft[scene]["generate"] for scene in scenes if scene in soft})


def parts(layout: Layout, scene: str, frame_set: str, use: str) -> list[str]:
    """Files of a scene's frames of one use."""
    settings = layout.entry("frame_sets", frame_set)
    if settings["path"] is not None:
        names = [part for part in settings["parts"][scene] if part.rsplit("_", 1)[0] == use]
        if settings["engine"] is not None:
            return [layout.paths.imported_frames("json", scene, frame_set, name) for name in names]
        return [f"{settings['path']}/{scene}/{name}.json" for name in names]
    total, shard = _counts(settings, scene, use)
    names = [f"{use}_{number}" for number in part_names(-(-total // shard))]
    return [layout.paths.frames("json", scene, frame_set, name) for name in names]


def arrays(parts: Iterable[str]) -> list[str]:
    """Arrays of parts, beside their JSON."""
    stems = ("buffers", "targets", "valid")
    return [f"{part.removesuffix('.json')}.{stem}.npy" for part in parts for stem in stems]


def tuned_scenes(layout: Layout, frame_set: str) -> list[str]:
    """Scenes with validation frames, for choosing constants of methods."""
    settings = layout.entry("frame_sets", frame_set)
    return list(settings["parts"]) if settings["path"] is not None else settings["scenes"]


def measured_scenes(layout: Layout, frame_set: str) -> list[str]:
    """Scenes with test frames."""
    settings = layout.entry("frame_sets", frame_set)
    unseen = [] if settings["path"] is not None else settings["unseen"]
    return [*tuned_scenes(layout, frame_set), *unseen]
