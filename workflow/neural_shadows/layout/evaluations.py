"""Jobs that tune, evaluate and time methods.

The views of the thesis's scenes are the frame set `views`: a group is a scene, of evaluations with a
batch as SCENE.BATCH. Other frame sets have the one group `all`.
"""

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from neural_shadows.errors import InputError
from neural_shadows.evaluation import frame
from neural_shadows.evaluation.registry import is_network, method_modules, unbiased
from neural_shadows.layout import frame_methods, frame_sets, tables
from neural_shadows.layout.layout import Layout
from neural_shadows.layout.parts import HELD_OUT, batches
from neural_shadows.layout.paths import ALL
from neural_shadows.sections.frame_sets import VIEWS
from neural_shadows.settings.base import not_among

# Modules that a stage imports by name.
IMPORTED = {
    "tune": [frame.KIND],
    "evaluate": [frame.KIND, frame.METRICS],
    "time_methods": [frame.TIMES],
    "answer_frames": [],
}


def tuned_files(layout: Layout, frame_set: str, group: str, method: str) -> dict[str, Any]:
    """Inputs of `tune`."""
    if _are_views(layout, frame_set, group, layout.mesh_scenes):
        return {
            "frames": [layout.paths.reference(group, HELD_OUT)],
            "meshes": [layout.paths.scene("mesh.ply", group)] * (not is_network(method)),
            "weights": layout.weights(method),
        }
    return {
        "frames": frame_sets.tuned(layout, frame_set),
        "sequences": frame_sets.tuned_sequences(layout, frame_set)
        if frame_methods.has_history(method)
        else [],
        "meshes": frame_sets.tuned_meshes(layout, frame_set),
        "weights": [],
        "fields": frame_methods.fields(layout, frame_set, method),
        "beside": frame_sets.tuned_arrays(layout, frame_set),
    }


def tuned_settings(layout: Layout, frame_set: str, group: str) -> dict[str, Any]:
    """Settings of `tune`."""
    return _view_settings(layout, group) if frame_set == VIEWS else {}


def evaluated_files(layout: Layout, frame_set: str, group: str, method: str) -> dict[str, Any]:
    """Inputs of `evaluate`."""
    parts = batches(layout.views)
    groups = (f"{scene}.{part}" for scene in layout.mesh_scenes for part in parts)
    if _are_views(layout, frame_set, group, groups):
        scene, batch = group.split(".")
        return {
            "frames": [layout.paths.reference(scene, batch)],
            "sequences": [],
            "meshes": [layout.paths.scene("mesh.ply", scene)] * (not is_network(method)),
            "weights": layout.weights(method),
            "constants_json": layout.bias_file(scene, method),
        }
    return {
        "frames": frame_sets.tests(layout, frame_set),
        "sequences": frame_sets.sequences(layout, frame_set),
        "meshes": frame_sets.all_meshes(layout, frame_set),
        "weights": frame_methods.weights(layout, method),
        "constants_json": frame_methods.chosen(layout, frame_set, method),
        "occluders": frame_methods.occluders(layout, frame_set, method),
        "fields": frame_methods.fields(layout, frame_set, method),
        "beside": frame_sets.tested_arrays(layout, frame_set),
    }


def evaluated_settings(layout: Layout, frame_set: str, group: str, method: str) -> dict[str, Any]:
    """Settings of `evaluate`."""
    if frame_set == VIEWS:
        bias = {"bias": layout.fixed_bias(method)}
        return _view_settings(layout, group.split(".")[0]) | bias
    return {
        "precision": frame_methods.precision(layout, method),
        "by_scene": frame_methods.by_scene(layout, method),
    }


def timed_files(layout: Layout, table: str, group: str) -> dict[str, Any]:
    """Inputs of `time_methods`."""
    frame_set = VIEWS if on_views(layout, table) else tables.frame_set(layout, table)
    if _are_views(layout, frame_set, group, layout.mesh_scenes):
        rows = tables.timed_rows(layout, table, group)
        return {
            "frames": [],
            "meshes": [layout.paths.scene("mesh.ply", group)],
            "constants": [],
            "weights": tables.networks(layout, rows, "weights.safetensors"),
            "fields": [],
        }
    names = [name for name in timed_methods(layout, table, group).values() if name]
    tests = frame_sets.first_tests(layout, frame_set)
    return {
        # Of the first and of the last scene: where networks are trained on some, one of these and one unseen.
        "frames": [*dict.fromkeys(tests[end] for end in (0, -1))],
        "meshes": frame_sets.all_meshes(layout, frame_set),
        "constants": tables.constants(layout, table),
        "weights": [layout.paths.network("weights.safetensors", name) for name in names],
        "fields": tables.unique(
            path
            for method in tables.methods(layout, table)
            for path in frame_methods.fields(layout, frame_set, method)
        ),
    }


def _are_views(layout: Layout, frame_set: str, group: str, groups: Iterable[str]) -> bool:
    """Check for views.

    Args:
        groups: those of views.

    Raises:
        InputError: no such frame set, or group of it.
    """
    layout.entry("frame_sets", frame_set)
    views = frame_set == VIEWS
    allowed = [*groups] if views else [ALL]
    if group not in allowed:
        raise InputError(f"frame_sets.{frame_set}: group {not_among(group, allowed)}")
    return views


def timed_methods(layout: Layout, table: str, group: str) -> dict[str, str | None]:
    """Timed experiment of each method, the first of several."""
    if on_views(layout, table):
        rows = tables.timed_rows(layout, table, group)
        return {row["method"]: row["experiment"] for row in rows}
    methods = tables.methods(layout, table)
    return {key: next(iter(frame_methods.experiments(layout, key)), None) for key in methods}


def timed_settings(layout: Layout, table: str, group: str) -> dict[str, Any]:
    """Settings of `time_methods`."""
    methods = {"methods": timed_methods(layout, table, group)}
    if not on_views(layout, table):
        return methods
    views = layout.mesh_scene(group)["frames"]
    timed = {"views": views, "frame_times": layout.settings["frame_times"]}
    return methods | timed | _view_settings(layout, group)


def _view_settings(layout: Layout, scene: str) -> dict[str, Any]:
    compute = layout.settings["compute"]
    described = {"scene": layout.mesh_scene(scene)["scene"]}
    return described | {key: compute[key] for key in ("device", "precision")}


def can_use_gpu(layout: Layout, frame_set: str, method: str) -> bool:
    """Check for a trained network on views."""
    return frame_set == VIEWS and layout.can_use_gpu(method)


def modules(layout: Layout, stage: str, frame_set: str, methods: Iterable[str]) -> set[Path]:
    """Modules imported by name for methods of a stage."""
    methods = [*methods]
    views = frame_set == VIEWS
    imported = {frame.module_file(names[not views]) for names in IMPORTED[stage]}
    imported |= method_modules(methods)
    if views:
        return imported | layout.network_modules(map(unbiased, filter(is_network, methods)))
    if stage == "tune" and any(map(frame_methods.has_history, methods)):
        imported.add(frame.module_file(frame.OF_SEQUENCES))
    networks = frame_methods.network_modules(layout, methods)
    imported |= {frame.module_file("screen_network_method") for _ in networks}
    of_frames = frame_sets.tuned_modules if stage == "tune" else frame_sets.modules
    return imported | networks | of_frames(layout, frame_set)


def timed_modules(layout: Layout, table: str, group: str) -> set[Path]:
    """`modules` of `time_methods`."""
    frame_set = VIEWS if on_views(layout, table) else tables.frame_set(layout, table)
    return modules(layout, "time_methods", frame_set, timed_methods(layout, table, group))


def on_views(layout: Layout, table: str) -> bool:
    """Check for methods timed on views, not on frames."""
    return "rows" in layout.entry("tables", table)
