"""Base classes of figures of scenes and fields."""

from pydantic import Field

from neural_shadows.sections.any_report import AnyFigure
from neural_shadows.sections.experiments import RayExperimentName
from neural_shadows.sections.scenes import MeshName
from neural_shadows.sections.sections import Sections
from neural_shadows.settings.base import check_among, name_in


class SceneFigure(AnyFigure):
    """Figure of a scene."""

    scene: MeshName = Field(description="a mesh in `scenes`")


class SamplingFigure(SceneFigure):
    """Figure of a scene and its ray sampling."""

    sampling: name_in("samplings") = Field(description="a name in `samplings`")


class FieldFigure(AnyFigure):
    """Figure of an occupancy field."""

    experiment: RayExperimentName = Field(description="name of an `occupancy_field`")

    def check(self, config: Sections, key: str) -> None:
        fields = [name for name in config.ray_experiments if config.network_of(name).holds_field]
        check_among(f"{key}.experiment", self.experiment, fields)
