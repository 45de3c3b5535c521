"""What each viewer is made of: its files, and what its stage is told."""

from typing import Any

from neural_shadows.layout import tables
from neural_shadows.layout.layout import Layout


def files(layout: Layout, viewer: str) -> dict[str, Any]:
    """The scene's mesh, and its networks with the depth biases that were found for them."""
    settings, paths = layout.entry("viewers", viewer), layout.paths
    scene, rows = settings["scene"], settings["rows"]
    return {
        "mesh_ply": paths.scene("mesh.ply", scene),
        "mesh_json": paths.scene("mesh.json", scene),
        "weights": tables.networks(layout, rows, "weights.safetensors"),
        "depth_biases": tables.depth_biases(layout, rows),
    }


def arguments(layout: Layout, viewer: str) -> dict[str, Any]:
    """What `write_viewer` is told beside its files."""
    settings = layout.entry("viewers", viewer)
    name = settings["scene"]
    scene = layout.entry("scenes", name)
    return {
        "name": name,
        "rows": settings["rows"],
        "scene": scene["scene"],
        "frames": scene["frames"],
        "views": layout.settings["rendering"]["views_per_set"],
        "about": layout.scenes([name])[name],
        "run": layout.run(),
    }


def encodings(layout: Layout, viewer: str) -> set[str]:
    """The kinds of a viewer's networks."""
    return layout.encodings(tables.experiments_of(layout.entry("viewers", viewer)["rows"]))


def labels(layout: Layout, viewer: str) -> dict[str, str]:
    """What Snakemake's report lists of a viewer."""
    return {"what": f"drag the light of the {layout.entry('viewers', viewer)['scene']}"}
