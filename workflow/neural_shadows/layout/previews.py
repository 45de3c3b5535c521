"""Pictures of scenes before anything is computed: files and settings."""

from pathlib import Path
from typing import Any

from neural_shadows.layout import frame_sets
from neural_shadows.layout.layout import Layout
from neural_shadows.scenes.generated import generator_module

_MESH, _ARRANGEMENT = "preview", "preview_arrangement"


def kind(layout: Layout, scene: str) -> str:
    """Stage that draws a scene: of a mesh, or of an arrangement in metres."""
    layout.entry("scenes", scene)
    return _MESH if scene in layout.mesh_scenes else _ARRANGEMENT


def files(layout: Layout, scene: str) -> dict[str, Any]:
    """Mesh of a scene, or meshes inserted into it."""
    if kind(layout, scene) == _MESH:
        return {f"mesh_{e}": layout.paths.scene(f"mesh.{e}", scene) for e in ("ply", "json")}
    inserted = layout.entry("scenes", scene)["arrangement"]["inserted"]
    return {"meshes": [layout.paths.scene("mesh.ply", name) for name in inserted]}


def modules(layout: Layout, scene: str) -> list[Path]:
    """Module of an arrangement's generator; none of a mesh."""
    if kind(layout, scene) == _MESH:
        return []
    return [generator_module(layout.entry("scenes", scene)["arrangement"]["generate"])]


def settings(layout: Layout, scene: str) -> dict[str, Any]:
    """Arguments of a scene's stage beside files."""
    entry = layout.entry("scenes", scene)
    if kind(layout, scene) == _MESH:
        return {"scene": entry["scene"], "advice": _advice(layout, scene)}
    return {
        "name": scene,
        "scene": entry["arrangement"],
        "seed": layout.settings["seed"],
        "advice": _advice(layout, scene),
    }


def _advice(layout: Layout, scene: str) -> str:
    """Next command to type: the first table with the scene that is not on request, and the last.

    The thesis's tables come first, and an overlay's, which are a user's own, last.
    """
    default = [name for name, table in layout.settings["tables"].items() if not table["on_request"]]
    tables = [name for name in default if _has(layout, name, scene)]
    if not tables:
        return f"Next: a table (`tables`) with {scene} in its rows or its frame set."
    first, last = (layout.paths.report(f"{tables[place]}.csv") for place in (0, -1))
    other = f", or another of {len(tables)} tables with it, the last {last}"
    return f"Next, with the same options: snakemake {first}{other if first != last else ''}."


def _has(layout: Layout, table: str, scene: str) -> bool:
    entry = layout.entry("tables", table)
    if any(row.get("scene") == scene for row in entry.get("rows", ())):
        return True
    frame_set = entry.get("frame_set")
    return frame_set is not None and scene in frame_sets.measured_scenes(layout, frame_set)
