"""`viewers`: interactive pages with a movable light."""

from pydantic import Field

from neural_shadows.sections.row_settings import RowSettings
from neural_shadows.settings.base import Model, name_in, section_or


class Viewer(Model):
    """Interactive scene with shadow maps of all sizes and networks."""

    scene: name_in("scenes") = Field(description="a name in `scenes`")
    networks: list[section_or(RowSettings, "method")] = Field(
        [], description="experiments of the scene: occupancy fields and the thesis's network"
    )
