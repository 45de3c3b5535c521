"""`viewers`: pages in which a scene's light can be dragged, by name."""

from typing import TYPE_CHECKING

from pydantic import Field

from neural_shadows.config.base import Model, name_in, section_or
from neural_shadows.config.experiments import network_of
from neural_shadows.config.tables import Row, RowSettings, row_of

if TYPE_CHECKING:
    from neural_shadows.config.whole import Config

SHADED = ("occupancy_field", "frequency")  # encodings that have a shader


class Viewer(Model):
    """A scene with shadow maps of all sizes and some networks, live in a browser."""

    scene: name_in("scenes") = Field(description="a name in `scenes`")
    networks: list[section_or(RowSettings, "method")] = Field(
        [], description="experiments of the scene: an `occupancy_field`, the thesis's network"
    )


def networks_of(config: "Config", name: str) -> list[Row]:
    """A viewer's networks, as `rows_of` gives them."""
    viewer = config.viewers[name]
    return [row_of(config, viewer.scene, row) for row in viewer.networks]


def check(config: "Config") -> None:
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
            encoding = network_of(config, row.method).encoding
            if encoding not in SHADED:
                raise ValueError(f"{key} is a {encoding}; a viewer can show {', '.join(SHADED)}")
