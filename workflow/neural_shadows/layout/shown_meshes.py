"""Meshes that reports show."""

from neural_shadows.layout import frame_sets
from neural_shadows.layout.layout import Layout
from neural_shadows.layout.report_inputs import Report


def shown_meshes(layout: Layout) -> list[str]:
    """Scenes with a mesh that a report is of, alone or inserted in its frames.

    With `only` not all are: these alone are prepared, pictured and named on the page.
    """
    shown: set[str] = set()
    for section in ("tables", "figures", "viewers"):
        for name, entry in layout.settings[section].items():
            shown |= {*Report(layout, name, entry).scenes}
            if frame_set := entry.get("frame_set"):
                scenes = frame_sets.measured_scenes(layout, frame_set)
                shown |= {*frame_sets.inserted(layout, scenes, frame_set)}
    for claim in layout.settings["claims"].values():
        shown |= {row["scene"] for rows in claim.get("rows") or () for row in rows}
    return [scene for scene in layout.mesh_scenes if scene in shown]
