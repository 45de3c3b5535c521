"""Files and settings of viewers."""

from pathlib import Path
from typing import Any

from neural_shadows.layout import frame_sets, tables
from neural_shadows.layout.layout import Layout
from neural_shadows.scenes.generated import generator_module

_HARD, _SOFT = "write_viewer", "write_soft_viewer"
# Files of `report/viewer` that the viewer of an area light has as well.
SHARED = """
    arrays.js bvh.js divider.js field_textures.js mesh.js orbit.js page.js vectors.js webgl.js
    base.html viewer.css screen.vert
    cones.glsl discs.glsl field.glsl field_values.glsl floats.glsl unit_sphere.glsl
""".split()


def stage(layout: Layout, viewer: str) -> str:
    """Stage that writes a viewer: under a sun, or under an area light."""
    return _SOFT if "frame_set" in layout.entry("viewers", viewer) else _HARD


def files(layout: Layout, viewer: str) -> dict[str, Any]:
    """Mesh, weights and held-out depth biases of a viewer; or meshes and weights."""
    settings, paths = layout.entry("viewers", viewer), layout.paths
    scene = settings["scene"]
    if stage(layout, viewer) == _SOFT:
        return {
            "meshes": frame_sets.meshes(layout, scene, settings["frame_set"]),
            "weights": [
                paths.network("weights.safetensors", name) for name in settings["networks"]
            ],
        }
    rows = settings["rows"]
    return {
        "mesh_ply": paths.scene("mesh.ply", scene),
        "mesh_json": paths.scene("mesh.json", scene),
        "weights": tables.networks(layout, rows, "weights.safetensors"),
        "depth_biases": tables.depth_biases(layout, rows),
    }


def arguments(layout: Layout, viewer: str) -> dict[str, Any]:
    """Arguments of a viewer's stage besides files."""
    settings = layout.entry("viewers", viewer)
    name = settings["scene"]
    if stage(layout, viewer) == _SOFT:
        return _soft_arguments(layout, settings)
    scene = layout.mesh_scene(name)
    return {
        "name": name,
        "rows": settings["rows"],
        "scene": scene["scene"],
        "frames": scene["frames"],
        "views": layout.views.views_per_set,
        "about": layout.scenes([name])[name],
        "run": layout.run(),
    }


def _soft_arguments(layout: Layout, settings: dict[str, Any]) -> dict[str, Any]:
    frames = layout.frames(settings["frame_set"])
    experiments = layout.settings["experiments"]
    return {
        "name": settings["scene"],
        "labels": [experiments[name]["label"] for name in settings["networks"]],
        "scene": layout.entry("scenes", settings["scene"])["arrangement"],
        "frames": {key: frames[key] for key in ("fov", "radii", "radius_unit")},
        "triangles": settings["triangles"],
        "resolution": settings["map"],
        "seed": layout.settings["seed"],
        "run": layout.run(),
    }


def modules(layout: Layout, viewer: str) -> set[Path]:
    """Modules of a viewer's networks, and of its scene's generator."""
    settings = layout.entry("viewers", viewer)
    if stage(layout, viewer) == _HARD:
        return layout.network_modules(tables.experiments_of(settings["rows"]))
    arrangement = layout.entry("scenes", settings["scene"])["arrangement"]
    networks = layout.network_modules(settings["networks"])
    return networks | {generator_module(arrangement["generate"])}


def labels(layout: Layout, viewer: str) -> dict[str, str]:
    """Labels of a viewer in Snakemake's report."""
    return {"what": f"drag the light of the {layout.entry('viewers', viewer)['scene']}"}
