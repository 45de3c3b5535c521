"""Checks of `viewers`."""

from neural_shadows.networks.kind_module import ENCODINGS
from neural_shadows.sections.sections import Sections
from neural_shadows.settings.kinds import kinds


def check(config: Sections) -> None:
    """Check scenes and kinds of the viewers' networks."""
    for name, viewer in config.viewers.items():
        for row in viewer.networks:
            key = f"viewers.{name}.networks: {row.method!r}"
            if row.method not in config.ray_experiments:
                raise ValueError(
                    f"{key} is not an experiment on rays. Remove it; shadow maps are always included"
                )
            scene = config.ray_experiments[row.method].scene
            if scene != viewer.scene:
                raise ValueError(f"{key} has the scene {scene!r}, the viewer {viewer.scene!r}")
            network = config.network_of(row.method)
            if not network.has_shader:
                shown = ", ".join(
                    n for n, kind in kinds(ENCODINGS).items() if kind.Settings.has_shader
                )
                raise ValueError(
                    f"{key} is a {network.encoding}, without a shader. Allowed: {shown}"
                )
