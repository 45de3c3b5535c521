"""`viewers`: pages in which a scene's light can be dragged, by name."""

from pydantic import Field

from neural_shadows.sections.row_settings import RowSettings
from neural_shadows.settings.base import Model, name_in, section_or


class Viewer(Model):
    """A scene with shadow maps of all sizes and some networks, live in a browser."""

    scene: name_in("scenes") = Field(description="a name in `scenes`")
    networks: list[section_or(RowSettings, "method")] = Field(
        [], description="experiments of the scene: an `occupancy_field`, the thesis's network"
    )
