"""The parts of frame sets: their files, and what each job renders."""

from collections.abc import Iterable, Mapping
from typing import Any

from neural_shadows.frames.uses import SEQUENCES
from neural_shadows.layout.layout import Layout
from neural_shadows.layout.parts import part_names

# What all frames of a set have in common, as `render_frames` takes it.
FRAME_KEYS = ("width", "height", "fov", "of", "light_map", "radii", "radius_unit", "twins", "blur")


def frame_settings(layout: Layout, scene: str, frame_set: str, part: str) -> dict[str, Any]:
    """What `render_frames` is told of a part: what all have in common, and which frames it is."""
    settings = layout.entry("frame_sets", frame_set)
    use, number = part.rsplit("_", 1)
    total, shard = _counts(settings, scene, use)
    first, train = int(number) * shard, use == "train"
    frames = {key: settings[key] for key in FRAME_KEYS}
    frames["width"] = (settings["train_width"] if train else None) or settings["width"]
    return {
        "scene": layout.entry("soft_scenes", scene),
        "name": scene,
        "seed": layout.settings["seed"],
        "frames": frames,
        "use": use,
        "first": first,
        "last": min(first + shard, total),
        # Noise of a target adds as much to each error: what is chosen by it needs few rays.
        "samples": settings["samples"]["train" if use in ("train", "validation") else "measured"],
        "twins": settings["twins"]["count"] * train,
    }


def _counts(settings: Mapping[str, Any], scene: str, use: str) -> tuple[int, int]:
    """How many frames of a use a scene has, and how many a part; a sequence is one part."""
    if use in SEQUENCES:
        return settings["sequence"], max(settings["sequence"], 1)
    total = settings[use]
    if use == "test" and scene in settings["unseen"]:
        total = settings["unseen_test"] or total
    return total, settings["shard"]


def engine_files(layout: Layout, scene: str, frame_set: str, part: str) -> list[str]:
    """The files of an engine's frame."""
    return layout.entry("frame_sets", frame_set)["engine"]["files"][scene][part]


def import_settings(layout: Layout, scene: str, frame_set: str) -> dict[str, Any]:
    """What `import_frame` is told of an engine's frames."""
    engine = layout.entry("frame_sets", frame_set)["engine"]
    kept = ("fov", "radii", "radius_unit", "channels", "targets")
    return {"size": engine["sizes"][scene], **{key: engine[key] for key in kept}}


def meshes(layout: Layout, scene: str) -> list[str]:
    """The meshes of the objects that stand in a scene; none in one of a user's own frames."""
    inserted = layout.settings["soft_scenes"].get(scene, {}).get("inserted", ())
    return [layout.paths.scene("mesh.ply", name) for name in inserted]


def generators(layout: Layout, scenes: Iterable[str]) -> list[str]:
    """The generators of some scenes, each once; a scene of a user's own frames has none."""
    known = layout.settings["soft_scenes"]
    return sorted({known[scene]["generate"] for scene in scenes if scene in known})


def parts(layout: Layout, scene: str, frame_set: str, use: str) -> list[str]:
    """The files of a scene's frames of one use: `train`, `validation`, `test`, or a sequence."""
    settings = layout.entry("frame_sets", frame_set)
    if settings["path"] is not None:
        names = [one for one in settings["parts"][scene] if one.rsplit("_", 1)[0] == use]
        if settings["engine"] is not None:
            return [layout.paths.imported_frames("json", scene, frame_set, name) for name in names]
        return [f"{settings['path']}/{scene}/{name}.json" for name in names]
    total, shard = _counts(settings, scene, use)
    names = [f"{use}_{number}" for number in part_names(-(-total // shard))]
    return [layout.paths.frames("json", scene, frame_set, name) for name in names]


def arrays(parts: Iterable[str]) -> list[str]:
    """The arrays of some parts, which lie beside their JSON."""
    stems = ("buffers", "targets", "valid")
    return [f"{part.removesuffix('.json')}.{stem}.npy" for part in parts for stem in stems]


def tuned_scenes(layout: Layout, frame_set: str) -> list[str]:
    """The scenes whose validation frames the constants of methods are chosen on."""
    settings = layout.entry("frame_sets", frame_set)
    return list(settings["parts"]) if settings["path"] is not None else settings["scenes"]


def measured_scenes(layout: Layout, frame_set: str) -> list[str]:
    """The scenes whose test frames methods are measured on."""
    settings = layout.entry("frame_sets", frame_set)
    unseen = [] if settings["path"] is not None else settings["unseen"]
    return [*tuned_scenes(layout, frame_set), *unseen]
