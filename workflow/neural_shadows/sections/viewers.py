"""`viewers`: interactive pages with a movable light."""

from typing import Annotated

from pydantic import Discriminator, Field, Tag

from neural_shadows.sections.experiments import ScreenExperimentName
from neural_shadows.sections.frame_sets import FrameSetName
from neural_shadows.sections.row_settings import RowSettings
from neural_shadows.sections.scenes import MeshName
from neural_shadows.settings.base import Model, has_key, name_in, section_or


class HardViewer(Model):
    """Interactive scene under a sun, with shadow maps of all sizes and networks."""

    scene: MeshName = Field(description="a mesh in `scenes`")
    networks: list[section_or(RowSettings, "method")] = Field(
        [], description="experiments of the scene: occupancy fields and the thesis's network"
    )


class SoftViewer(Model):
    """Interactive scene under an area light, with maps, rays, cones, filters and networks."""

    scene: name_in("scenes") = Field(
        description="an arrangement in `scenes`; a mesh stands alone on a stage"
    )
    frame_set: FrameSetName = Field(
        description="whose largest radius the light can have, and whose field of view the camera has"
    )
    networks: list[ScreenExperimentName] = Field(
        [],
        description="experiments on frames, of a form, `ends` and `answer` with a shader",
    )
    triangles: int = Field(
        60_000, ge=100, le=500_000, description="most triangles shown; objects are decimated to it"
    )
    map: int = Field(1024, ge=64, le=2048, description="texels along a side of the light's map")


Viewer = Annotated[
    Annotated[HardViewer, Tag("Sun")] | Annotated[SoftViewer, Tag("AreaLight")],
    Discriminator(lambda viewer: "AreaLight" if has_key(viewer, "frame_set") else "Sun"),
]
