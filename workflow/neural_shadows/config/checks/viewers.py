"""Checks of `viewers`."""

from neural_shadows.networks.kind_module import ENCODINGS
from neural_shadows.networks.settings.screen_space import SHADED
from neural_shadows.sections.frame_sets import RenderedFrames
from neural_shadows.sections.sections import Sections
from neural_shadows.sections.viewers import HardViewer, SoftViewer
from neural_shadows.settings.kinds import kinds


def check(config: Sections) -> None:
    """Check scenes, frame sets and kinds of the viewers' networks."""
    for name, viewer in config.viewers.items():
        if isinstance(viewer, SoftViewer):
            _check_soft(config, f"viewers.{name}", viewer)
        else:
            _check_hard(config, f"viewers.{name}", viewer)


def _check_soft(config: Sections, key: str, viewer: SoftViewer) -> None:
    if config.arrangement(viewer.scene).new_layouts:
        raise ValueError(
            f"{key}.scene: {viewer.scene!r} has a layout of its own for each part. Name a scene without "
            "`new_layouts`"
        )
    frames = config.frame_sets[viewer.frame_set]
    if not isinstance(frames, RenderedFrames) or frames.light.shape != "sphere":
        raise ValueError(
            f"{key}.frame_set: {viewer.frame_set!r} has no sphere as its light. Name a rendered frame set "
            "with one"
        )
    for name in viewer.networks:
        network = config.network_of(name)
        for part, shown in SHADED.items():
            value = getattr(network, part, shown[0])
            if value not in shown:
                raise ValueError(
                    f"{key}.networks: {name!r} has {part}: {value}, without a shader. Allowed: "
                    f"{', '.join(shown)}"
                )


def _check_hard(config: Sections, key: str, viewer: HardViewer) -> None:
    for row in viewer.networks:
        key_of_row = f"{key}.networks: {row.method!r}"
        if row.method not in config.ray_experiments:
            raise ValueError(
                f"{key_of_row} is not an experiment on rays. Remove it; shadow maps are always included"
            )
        scene = config.ray_experiments[row.method].scene
        if scene != viewer.scene:
            raise ValueError(f"{key_of_row} has the scene {scene!r}, the viewer {viewer.scene!r}")
        network = config.network_of(row.method)
        if not network.has_shader:
            shown = ", ".join(n for n, kind in kinds(ENCODINGS).items() if kind.Settings.has_shader)
            raise ValueError(
                f"{key_of_row} is a {network.encoding}, without a shader. Allowed: {shown}"
            )
