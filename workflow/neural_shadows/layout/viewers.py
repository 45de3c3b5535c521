"""Files and settings of viewers."""

from typing import Any

from neural_shadows.layout import tables
from neural_shadows.layout.layout import Layout


def files(layout: Layout, viewer: str) -> dict[str, Any]:
    """Mesh, weights and held-out depth biases of a viewer."""
    settings, paths = layout.entry("viewers", viewer), layout.paths
    scene, rows = settings["scene"], settings["rows"]
    return {
        "mesh_ply": paths.scene("mesh.ply", scene),
        "mesh_json": paths.scene("mesh.json", scene),
        "weights": tables.networks(layout, rows, "weights.safetensors"),
        "depth_biases": tables.depth_biases(layout, rows),
    }


def arguments(layout: Layout, viewer: str) -> dict[str, Any]:
    """Arguments of `write_viewer` besides files."""
    settings = layout.entry("viewers", viewer)
    name = settings["scene"]
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


def encodings(layout: Layout, viewer: str) -> set[str]:
    """Kinds of a viewer's networks."""
    return layout.encodings(tables.experiments_of(layout.entry("viewers", viewer)["rows"]))


def labels(layout: Layout, viewer: str) -> dict[str, str]:
    """Labels of a viewer in Snakemake's report."""
    return {"what": f"drag the light of the {layout.entry('viewers', viewer)['scene']}"}
