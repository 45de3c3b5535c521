"""The parts of frame sets: their files, and what each job renders."""

from collections.abc import Iterable
from typing import Any

from neural_shadows.frames.draw_sequences import SEQUENCES
from neural_shadows.layout.layout import Layout
from neural_shadows.layout.parts import part_names


def frame_settings(layout: Layout, scene: str, frame_set: str, part: str) -> dict[str, Any]:
    """What `render_frames` is told of a part: what all have in common, and which frames it is."""
    settings = layout.entry("frame_sets", frame_set)
    use, number = part.rsplit("_", 1)
    total = settings["sequence"] if use in SEQUENCES else settings[use]
    first = int(number) * settings["shard"]
    samples = settings["samples"]["train" if use == "train" else "measured"]
    return {
        "scene": layout.entry("soft_scenes", scene),
        "frames": settings,
        "use": use,
        "first": first,
        "last": min(first + settings["shard"], total),
        "samples": samples,
        "twins": settings["twins"]["count"] * (use == "train"),
    }


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
        return [f"{settings['path']}/{scene}/{name}.json" for name in names]
    total = settings["sequence"] if use in SEQUENCES else settings[use]
    names = [f"{use}_{number}" for number in part_names(-(-total // settings["shard"]))]
    return [layout.paths.frames("json", scene, frame_set, name) for name in names]


def tuned_scenes(layout: Layout, frame_set: str) -> list[str]:
    """The scenes whose validation frames the constants of methods are chosen on."""
    settings = layout.entry("frame_sets", frame_set)
    return list(settings["parts"]) if settings["path"] is not None else settings["scenes"]


def measured_scenes(layout: Layout, frame_set: str) -> list[str]:
    """The scenes whose test frames methods are measured on."""
    settings = layout.entry("frame_sets", frame_set)
    unseen = [] if settings["path"] is not None else settings["unseen"]
    return [*tuned_scenes(layout, frame_set), *unseen]
