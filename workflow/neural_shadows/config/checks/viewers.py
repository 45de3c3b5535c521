"""What must hold of `viewers`."""

from neural_shadows.networks.kind_module import ENCODINGS
from neural_shadows.sections.sections import Sections
from neural_shadows.settings.kinds import kinds


def check(config: Sections) -> None:
    """Check that each network is of the viewer's scene, and of a kind that has a shader."""
    for name, viewer in config.viewers.items():
        for row in viewer.networks:
            key = f"viewers.{name}.networks: {row.method!r}"
            if row.method not in config.experiments:
                raise ValueError(
                    f"{key} is no experiment; shadow maps are there without being named"
                )
            scene = config.experiments[row.method].scene
            if scene != viewer.scene:
                raise ValueError(f"{key} is of scene {scene!r}, the viewer of {viewer.scene!r}")
            network = config.network_of(row.method)
            if not network.has_shader:
                shown = ", ".join(
                    n for n, kind in kinds(ENCODINGS).items() if kind.Settings.has_shader
                )
                raise ValueError(f"{key} is a {network.encoding}; a viewer can show {shown}")
