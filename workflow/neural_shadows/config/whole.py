"""The whole configuration: its sections, explained in the files of their names.

`python -m neural_shadows.config` prints the JSON schema made from it
(workflow/schemas/config.schema.json).
"""

from typing import Annotated

from pydantic import Field, model_validator

from neural_shadows.config import (
    claims,
    experiments,
    figures,
    frame_sets,
    learning_curves,
    networks_by_scene,
    scenes,
    screen_experiments,
    soft_scenes,
    tables,
    viewers,
)
from neural_shadows.config.base import Model, Name, Seed
from neural_shadows.config.claims import Claim
from neural_shadows.config.compute import Compute
from neural_shadows.config.experiments import Experiment
from neural_shadows.config.figures import Figure
from neural_shadows.config.frame_sets import FrameSet
from neural_shadows.config.frame_times import FrameTimes
from neural_shadows.config.learning_curves import LearningCurves
from neural_shadows.config.metrics import Metrics
from neural_shadows.config.networks import Network
from neural_shadows.config.networks_by_scene import NetworksByScene
from neural_shadows.config.rendering import Rendering
from neural_shadows.config.samplings import Sampling
from neural_shadows.config.scenes import Scene
from neural_shadows.config.screen_experiments import ScreenExperiment
from neural_shadows.config.screen_networks import ScreenNetwork
from neural_shadows.config.screen_profiles import ScreenProfiles
from neural_shadows.config.screen_trainings import ScreenTraining
from neural_shadows.config.soft_scenes import SoftScene
from neural_shadows.config.tables import Table
from neural_shadows.config.trainings import Training
from neural_shadows.config.viewers import Viewer

# Folders below results/ and reports/, where an overlay's own folder of this name would mix with
# the default's files.
RESERVED_SCALES = {
    *("scenes", "rays", "networks", "references", "answers", "evaluations", "depth_biases"),
    *("frame_times", "cost", "logs", "benchmarks", "reference"),
    *("frames", "imported_frames", "occluders", "soft_constants", "soft_evaluations", "soft_times"),
    *("screen_networks", "screen_profiles", "screen_sensitivities", "soft_fields"),
}


class Config(Model):
    """The whole configuration."""

    scale: Name = Field(description="name of this configuration; overlays write below it")
    seed: Seed = Field(description="seed of everything that is drawn")
    dragon: str | None = Field(
        None, min_length=1, description="the dragon's mesh: `wyrm`, `stanford`, or a file"
    )
    compute: Compute = Field(Compute(), description="what the networks run on")
    scenes: dict[Name, Scene] = Field(description="meshes, how they stand and are lit, by name")
    samplings: dict[Name, Sampling] = Field(description="ways to draw training rays, by name")
    networks: dict[Name, Network] = Field(description="network shapes, by name")
    trainings: dict[Name, Training] = Field(description="optimiser settings, by name")
    experiments: dict[Name, Experiment] = Field(description="networks, by name")
    learning_curves: LearningCurves | None = Field(
        None, description="networks trained anew at several budgets, from several seeds"
    )
    rendering: Rendering = Field(description="frames and viewpoints of all scenes")
    soft_scenes: dict[Name, SoftScene] = Field(
        {}, description="several objects in metres, lit by a light at a place, by name"
    )
    frame_sets: dict[Name, FrameSet] = Field(
        {}, description="frames with buffers and exact soft shadows, by name"
    )
    screen_networks: dict[Name, ScreenNetwork] = Field(
        {}, description="shapes of networks that answer whole frames, by name"
    )
    screen_trainings: dict[Name, ScreenTraining] = Field(
        {}, description="how networks of whole frames learn, by name"
    )
    screen_experiments: dict[Name, ScreenExperiment] = Field(
        {}, description="networks of whole frames that are trained, by name"
    )
    networks_by_scene: dict[Name, NetworksByScene] = Field(
        {}, description="methods that are one of these for each scene, by name"
    )
    screen_profiles: ScreenProfiles = Field(
        ScreenProfiles(), description="how these are timed, level by level"
    )
    metrics: Metrics = Field(Metrics(), description="settings of the image metrics")
    frame_times: FrameTimes = Field(FrameTimes(), description="how frame times are measured")
    tables: dict[Name, Table] = Field({}, description="by name: `table_` and the thesis's number")
    figures: dict[Annotated[str, Field(pattern=r"^figure_[a-z0-9_]+$")], Figure] = Field(
        {}, description="figures to draw, by name: `figure_` and the thesis's number"
    )
    viewers: dict[Annotated[str, Field(pattern=r"^viewer(_[a-z0-9_]+)?$")], Viewer] = Field(
        {}, description="pages in which the light can be dragged, by name: `viewer`, `viewer_NAME`"
    )
    claims: dict[Name, Claim] = Field({}, description="what the thesis concludes, by name")

    @model_validator(mode="after")
    def _check(self):
        if self.scale in RESERVED_SCALES:
            raise ValueError(
                f"scale = {self.scale!r}: is the name of a folder of results; choose another"
            )
        for section in (
            scenes,
            soft_scenes,
            frame_sets,
            experiments,
            screen_experiments,
            networks_by_scene,
            learning_curves,
            tables,
            figures,
            viewers,
            claims,
        ):
            section.check(self)
        return self
