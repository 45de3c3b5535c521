"""`viewers`: interactive pages with a movable light."""

from pydantic import Field

from neural_shadows.sections.row_settings import RowSettings
from neural_shadows.sections.scenes import MeshName
from neural_shadows.settings.base import Model, section_or


class Viewer(Model):
    """Interactive scene with shadow maps of all sizes and networks."""

    scene: MeshName = Field(description="a mesh in `scenes`")
    networks: list[section_or(RowSettings, "method")] = Field(
        [], description="experiments of the scene: occupancy fields and the thesis's network"
    )
