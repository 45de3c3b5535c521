"""Settings of jobs that measure hours of sun."""

from typing import Any

from neural_shadows.layout.layout import Layout

KEYS = ("resolution", "points", "width", "latitude", "day", "minutes")


def settings(layout: Layout, table: str, scene: str) -> dict[str, Any]:
    """Arguments of `measure_sun_hours` beside files."""
    entry, of_scene = layout.entry("tables", table, "latitude"), layout.mesh_scene(scene)
    own = {key: entry[key] for key in KEYS}
    return own | {"up": of_scene["scene"]["up"], "seed": of_scene["seed"]}
