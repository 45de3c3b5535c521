"""Files and arguments of `manifest.write_manifest`."""

import hashlib
import json
from pathlib import Path
from typing import Any

from neural_shadows.layout.layout import Layout
from neural_shadows.layout.shown_meshes import shown_meshes
from neural_shadows.reports import targets


def files(layout: Layout) -> dict[str, Any]:
    """All default reports, with stills of viewers, and the descriptions of meshes."""
    stills = [layout.paths.report(f"{viewer}.png") for viewer in layout.settings["viewers"]]
    return {
        "reports": [*targets.all_reports(layout), *stills],
        "meshes": [layout.paths.scene("mesh.json", scene) for scene in shown_meshes(layout)],
    }


def arguments(layout: Layout) -> dict[str, Any]:
    """Arguments besides files."""
    settings = json.dumps(layout.settings, sort_keys=True, default=str)
    return {
        "on_request": on_request(layout),
        "run": layout.run(),
        "configuration": hashlib.sha256(settings.encode()).hexdigest(),
        "logs": layout.paths.logs,
        "benchmarks": layout.paths.benchmarks,
    }


def on_request(layout: Layout) -> dict[str, float]:
    """Available reports besides the default ones, by path with their age.

    They are none of the inputs: a manifest makes nothing of them anew.
    """
    endings = {"tables": ("csv", "md", "json"), "figures": ("png", "svg")}
    paths = [
        layout.paths.report(f"{name}.{ending}")
        for section in endings
        for name in layout.settings[section]
        for ending in endings[section]
    ]
    default = {*targets.all_reports(layout)}
    made = [Path(path) for path in paths if path not in default and Path(path).exists()]
    return {str(path): path.stat().st_mtime for path in made}
