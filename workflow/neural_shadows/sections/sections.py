"""All sections of a configuration but its reports, and what follows from several of them."""

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import Field

from neural_shadows.sections.any_report import AnyClaim, AnyFigure, AnyTable
from neural_shadows.sections.compute import Compute
from neural_shadows.sections.experiments import Experiment
from neural_shadows.sections.frame_sets import FrameSet
from neural_shadows.sections.frame_times import FrameTimes
from neural_shadows.sections.learning_curves import LearningCurves
from neural_shadows.sections.metrics import Metrics
from neural_shadows.sections.networks import Network, ScreenNetwork
from neural_shadows.sections.networks_by_scene import NetworksByScene
from neural_shadows.sections.rendering import Rendering
from neural_shadows.sections.samplings import Sampling
from neural_shadows.sections.scenes import Scene
from neural_shadows.sections.screen_experiments import ScreenExperiment
from neural_shadows.sections.screen_profiles import ScreenProfiles
from neural_shadows.sections.screen_trainings import ScreenTraining
from neural_shadows.sections.soft_scenes import SoftScene
from neural_shadows.sections.trainings import Training
from neural_shadows.sections.viewers import Viewer
from neural_shadows.settings.base import Model, Name, Seed

FigureName = Annotated[str, Field(pattern=r"^figure_[a-z0-9_]+$")]
ViewerName = Annotated[str, Field(pattern=r"^viewer(_[a-z0-9_]+)?$")]


class Sections(Model):
    """A configuration; `config.whole` gives its tables, figures and claims their kinds."""

    scale: Name = Field(description="name of this configuration; overlays write below it")
    seed: Seed = Field(description="seed of everything that is drawn")
    dragon: str | None = Field(
        None, min_length=1, description="the dragon's mesh: `wyrm`, `stanford`, or a file"
    )
    up: Literal["x", "y", "z"] | None = Field(
        None, description="the axis of the dragon's mesh that points up, in place of its scene's"
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
    tables: Mapping[Name, AnyTable] = Field(
        {}, description="by name: `table_` and the thesis's number"
    )
    figures: Mapping[FigureName, AnyFigure] = Field(
        {}, description="figures to draw, by name: `figure_` and the thesis's number"
    )
    viewers: dict[ViewerName, Viewer] = Field(
        {}, description="pages in which the light can be dragged, by name: `viewer`, `viewer_NAME`"
    )
    claims: Mapping[Name, AnyClaim] = Field({}, description="what the thesis concludes, by name")

    def network_of(self, experiment: str) -> Any:
        """The section of an experiment's network."""
        network = self.experiments[experiment].network
        return self.networks[network] if isinstance(network, str) else network

    def training_of(self, experiment: str) -> Training | None:
        """The section of an experiment's training; None for a network that is only built."""
        training = self.experiments[experiment].training
        return self.trainings[training] if isinstance(training, str) else training

    def seed_of(self, experiment: str) -> int:
        """An experiment's seed: its own, its scene's or the configuration's."""
        settings = self.experiments[experiment]
        seeds = settings.seed, self.scenes[settings.scene].seed, self.seed
        return next(seed for seed in seeds if seed is not None)

    def label_of(self, experiment: str, label: str | None = None) -> str:
        """A label, the experiment's own by default, with the settings that its braces name.

        Raises:
            ValueError: it names a setting that the experiment's network and training do not have.
        """
        label = label or self.experiments[experiment].label or experiment
        training = self.training_of(experiment)
        settings = training.model_dump() if training else {}
        settings |= self.network_of(experiment).model_dump()
        try:
            return label.format(**settings)
        except (LookupError, ValueError, TypeError, AttributeError) as error:
            raise ValueError(
                f"the label {label!r} of {experiment}: what stands in braces should be a setting of "
                f"its network or training; allowed: {', '.join(settings)}"
            ) from error

    def points_of(self, experiment: str) -> list[dict[str, Any]]:
        """The points of an experiment's learning curve, by steps and then by seed.

        Returns: of each `experiment`, the name of the network that is trained for it; `steps`;
            `seed`; `samples`, steps × batch. The experiment itself is the point of its own steps
            and seed.
        """
        curves, training = self.learning_curves, self.training_of(experiment)
        own_seed = self.seed_of(experiment)
        points = []
        for steps in curves.steps:
            for seed in range(own_seed, own_seed + curves.seeds):
                own = (steps, seed) == (training.steps, own_seed)
                name = experiment if own else f"{experiment}_{steps}_steps_seed_{seed}"
                samples = steps * training.batch_size
                points.append(
                    {"experiment": name, "steps": steps, "seed": seed, "samples": samples}
                )
        return points

    def layout_seed(self, scene: str) -> int:
        """The seed that the layout of a scene in metres is drawn from."""
        seed = self.soft_scenes[scene].seed
        return self.seed if seed is None else seed

    def screen_network_of(self, experiment: str) -> Any:
        """The section of a screen-space experiment's network."""
        network = self.screen_experiments[experiment].network
        return self.screen_networks[network] if isinstance(network, str) else network

    def screen_training_of(self, experiment: str) -> ScreenTraining:
        """The section of a screen-space experiment's training."""
        training = self.screen_experiments[experiment].training
        return self.screen_trainings[training] if isinstance(training, str) else training

    def screen_seed_of(self, experiment: str) -> int:
        """A screen-space experiment's seed: its own or the configuration's."""
        seed = self.screen_experiments[experiment].seed
        return self.seed if seed is None else seed

    def differences(self, experiment: str, other: str) -> list[str]:
        """The keys in which two screen-space experiments differ, but for `seed` and `label`."""
        first, second = (dict(self.screen_experiments[name]) for name in (experiment, other))
        return [k for k in first if k not in ("seed", "label") and first[k] != second[k]]
