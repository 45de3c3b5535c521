"""Parts of frame sets: files and settings of their jobs."""

from collections.abc import Iterable, Mapping
from itertools import cycle, islice
from pathlib import Path
from typing import Any

from neural_shadows.frames.uses import SEQUENCES, TUNED_SEQUENCES, USES, motion_of, use_of
from neural_shadows.layout.layout import Layout
from neural_shadows.layout.parts import part_names
from neural_shadows.rendering.light_shape import shape_module
from neural_shadows.scenes.generated import generator_module

MEASURED_OF_LAYOUT = 2  # validation or test frames of each new layout of a scene
# Settings shared by all frames of a set.
FRAME_KEYS = (
    *("width", "height", "fov", "of", "light", "light_map"),
    *("radii", "radius_unit", "twins", "blur"),
)


def frame_settings(layout: Layout, scene: str, frame_set: str, part: str) -> dict[str, Any]:
    """Settings of `render_frames` for a part."""
    settings = layout.frames(frame_set)
    use, number = part.rsplit("_", 1)
    total, shard = _counts(layout, settings, scene, use)
    first, is_training = int(number) * shard, use == "train"
    frames = {key: settings[key] for key in FRAME_KEYS}
    if is_training:
        frames["width"] = settings["train_width"] or settings["width"]
    else:
        frames["twins"] = {"count": 0}  # so that other ones render no test anew
    return {
        "scene": _arrangement(layout, scene, use, int(number)),
        "name": scene,
        "seed": layout.settings["seed"],
        "frames": frames,
        "use": use,
        "first": first,
        "last": min(first + shard, total),
        # Noise of targets adds equally to all errors: choosing among them needs few rays.
        "samples": settings["samples"][
            "train" if use in ("train", "validation", *TUNED_SEQUENCES) else "measured"
        ],
        # A method of rays traces its own in tests.
        "rays": settings["rays"] * (use in ("train", "validation")),
    }


def _arrangement(layout: Layout, scene: str, use: str, number: int) -> dict[str, Any]:
    """Settings of a part's scene; with new layouts its seed is the part's own."""
    entry = layout.entry("scenes", scene)
    if not entry["new_layouts"]:
        return entry["arrangement"]
    return entry["arrangement"] | {"seed": [entry["arrangement"]["seed"], USES.index(use), number]}


def _counts(layout: Layout, settings: Mapping[str, Any], scene: str, use: str) -> tuple[int, int]:
    """Frames of a scene and use, and frames per part."""
    if motion_of(use):
        return settings["sequence"], max(settings["sequence"], 1)
    total = settings[use]
    if use == "test" and scene in settings["unseen"]:
        total = settings["unseen_test"] or total
    if use != "train" and layout.entry("scenes", scene)["new_layouts"]:
        return total, MEASURED_OF_LAYOUT
    return total, settings["shard"]


def engine_files(layout: Layout, scene: str, frame_set: str, part: str) -> list[str]:
    """Files of an engine's frame."""
    return layout.frames(frame_set)["engine"]["files"][scene][part]


def import_settings(layout: Layout, scene: str, frame_set: str) -> dict[str, Any]:
    """Settings of `import_frame` for an engine's frames."""
    engine = layout.frames(frame_set)["engine"]
    keys = ("fov", "radii", "radius_unit", "channels", "targets")
    return {"size": engine["sizes"][scene], **{key: engine[key] for key in keys}}


def inserted(layout: Layout, scenes: Iterable[str], frame_set: str) -> list[str]:
    """Names of the scenes' inserted objects; none of a user's frames."""
    arrangements = _arrangements(layout, scenes, frame_set)
    return [name for one in arrangements for name in one["inserted"]]


def meshes(layout: Layout, scene: str, frame_set: str) -> list[str]:
    """Meshes of a scene's inserted objects; none of a user's frames."""
    return [layout.paths.scene("mesh.ply", name) for name in inserted(layout, [scene], frame_set)]


def generators(layout: Layout, frame_set: str, scenes: Iterable[str] | None = None) -> set[Path]:
    """Modules of generators, of all scenes or some; none of a user's frames."""
    names = measured_scenes(layout, frame_set) if scenes is None else scenes
    return {generator_module(one["generate"]) for one in _arrangements(layout, names, frame_set)}


def _arrangements(layout: Layout, scenes: Iterable[str], frame_set: str) -> list[Mapping[str, Any]]:
    if layout.frames(frame_set)["path"] is not None:
        return []
    return [layout.entry("scenes", scene)["arrangement"] for scene in scenes]


def modules(layout: Layout, frame_set: str, scenes: Iterable[str] | None = None) -> set[Path]:
    """Modules of generators and of lights' shape; none of a user's frames."""
    settings = layout.frames(frame_set)
    if settings["path"] is not None:
        return set()
    return generators(layout, frame_set, scenes) | {shape_module(settings["light"]["shape"])}


def parts(layout: Layout, scene: str, frame_set: str, use: str) -> list[str]:
    """Files of a scene's frames of one use."""
    settings = layout.frames(frame_set)
    if settings["path"] is not None:
        names = [part for part in settings["parts"][scene] if use_of(part) == use]
        if settings["engine"] is not None:
            return [layout.paths.imported_frames("json", scene, frame_set, name) for name in names]
        return [f"{settings['path']}/{scene}/{name}.json" for name in names]
    total, shard = _counts(layout, settings, scene, use)
    names = [f"{use}_{number}" for number in part_names(-(-total // shard))]
    return [layout.paths.frames("json", scene, frame_set, name) for name in names]


def arrays(layout: Layout, frame_set: str, parts: Iterable[str]) -> list[str]:
    """Arrays of a user's parts, beside their JSON.

    None of others: their stage writes them with the JSON, and to plan 12,000 such inputs took 2 s.
    """
    settings = layout.frames(frame_set)
    if settings["path"] is None or settings["engine"] is not None:
        return []
    stems = ("buffers", "targets", "valid")
    return [f"{part.removesuffix('.json')}.{stem}.npy" for part in parts for stem in stems]


def tuned_scenes(layout: Layout, frame_set: str) -> list[str]:
    """Scenes with validation frames, for choosing constants of methods."""
    settings = layout.frames(frame_set)
    return list(settings["parts"]) if settings["path"] is not None else settings["scenes"]


def measured_scenes(layout: Layout, frame_set: str) -> list[str]:
    """Scenes with test frames."""
    settings = layout.frames(frame_set)
    unseen = [] if settings["path"] is not None else settings["unseen"]
    return [*tuned_scenes(layout, frame_set), *unseen]


def fitted_parts(layout: Layout, frame_set: str) -> list[str]:
    """Frames with scenes covered by the fields."""
    uses = tests(layout, frame_set), tuned(layout, frame_set), sequences(layout, frame_set)
    return [part for parts in uses for part in parts]


def tests(layout: Layout, frame_set: str) -> list[str]:
    """Test parts of a frame set."""
    scenes = measured_scenes(layout, frame_set)
    return [part for name in scenes for part in parts(layout, name, frame_set, "test")]


def validations(layout: Layout, frame_set: str) -> list[str]:
    """Validation parts of a frame set."""
    scenes = tuned_scenes(layout, frame_set)
    return [p for name in scenes for p in parts(layout, name, frame_set, "validation")]


def tested_arrays(layout: Layout, frame_set: str) -> list[str]:
    """Arrays of a user's test frames."""
    return arrays(layout, frame_set, tests(layout, frame_set))


def tuned_arrays(layout: Layout, frame_set: str) -> list[str]:
    """Arrays of a user's validation frames, on which constants are chosen."""
    return arrays(layout, frame_set, validations(layout, frame_set))


def tuned_parts(layout: Layout, frame_set: str) -> dict[str, list[str]]:
    """Parts on which the constants of methods are chosen, by frame set: of another each scene's first."""
    settings, found = layout.frames(frame_set), {frame_set: validations(layout, frame_set)}
    also = settings["tuned_also_on"] if settings["path"] is None else None
    if also is not None:
        scenes = tuned_scenes(layout, also)
        found[also] = [parts(layout, scene, also, "validation")[0] for scene in scenes]
    return found


def tuned(layout: Layout, frame_set: str) -> list[str]:
    """All of `tuned_parts`."""
    return [part for parts in tuned_parts(layout, frame_set).values() for part in parts]


def tuned_meshes(layout: Layout, frame_set: str) -> list[str]:
    """`all_meshes`, with those of the other frames on which constants are chosen."""
    sets = tuned_parts(layout, frame_set)
    return list(dict.fromkeys(mesh for one in sets for mesh in all_meshes(layout, one)))


def fitted_generators(layout: Layout, frame_set: str) -> set[Path]:
    """Modules of the generators of all objects covered by the fields."""
    return set().union(*(generators(layout, one) for one in tuned_parts(layout, frame_set)))


def tuned_modules(layout: Layout, frame_set: str) -> set[Path]:
    """`modules` of all frames on which constants are chosen."""
    return set().union(*(modules(layout, one) for one in tuned_parts(layout, frame_set)))


def all_meshes(layout: Layout, frame_set: str) -> list[str]:
    """Meshes of all inserted objects of a frame set, each once."""
    scenes = measured_scenes(layout, frame_set)
    paths = [mesh for scene in scenes for mesh in meshes(layout, scene, frame_set)]
    return list(dict.fromkeys(paths))


def sequences(layout: Layout, frame_set: str) -> list[str]:
    """Measured sequences of a frame set, by scene."""
    settings = layout.frames(frame_set)
    if settings["path"] is not None:
        return []
    scenes = settings["moving"] or settings["scenes"][:1]
    pairs = ((scene, use) for scene in scenes for use in SEQUENCES)
    return [part for scene, use in pairs for part in parts(layout, scene, frame_set, use)]


def tuned_sequences(layout: Layout, frame_set: str) -> list[str]:
    """Sequences on which constants of histories are chosen, if the set has any: of each scene and each motion."""
    settings = layout.frames(frame_set)
    if settings["path"] is not None:
        return []
    count = max(len(settings["scenes"]), len(TUNED_SEQUENCES))
    pairs = islice(zip(cycle(settings["scenes"]), cycle(TUNED_SEQUENCES)), count)
    return [part for scene, use in pairs for part in parts(layout, scene, frame_set, use)]


def first_tests(layout: Layout, frame_set: str) -> list[str]:
    """First test part of each scene."""
    scenes = measured_scenes(layout, frame_set)
    return [parts(layout, scene, frame_set, "test")[0] for scene in scenes]
