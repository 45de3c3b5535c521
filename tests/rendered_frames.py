"""Parts of a frame set of a generated scene, rendered small."""

from collections.abc import Mapping
from pathlib import Path

from neural_shadows.frames.render_frames import render_frames

FRAMES = {
    **{"width": 48, "height": 24, "fov": 55, "of": None, "blur": 0.0},
    "light_map": {"kind": "perspective", "fov": 120, "resolution": 64},
    **{"radii": [0, 0.1, 0.25], "radius_unit": "metres"},
    "twins": {"count": 0},
}


def render_part(
    folder: Path, use: str, frames: Mapping = FRAMES, scene: str = "blinds", **settings
) -> Path:
    """Render a part of two frames; its JSON.

    Args:
        frames: what differs from `FRAMES`.
        settings: other ones of `render_frames`.
    """
    folder.mkdir(parents=True, exist_ok=True)
    part = folder / f"{use}_000.json"
    names = ("buffers", "targets", "valid", "edges", "rays")
    arrays = (part.with_suffix(f".{name}.npy") for name in names)
    settings = {"first": 0, "last": 2, "samples": 8, "name": scene, "seed": 3} | settings
    settings |= {"scene": {"generate": scene, "seed": 3, "inserted": {}}}
    render_frames([], part, *arrays, frames=FRAMES | dict(frames), use=use, **settings)
    return part
