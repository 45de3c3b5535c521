"""All sections of a configuration, with values derived from several."""

from collections.abc import Mapping
from functools import cached_property
from itertools import product
from typing import Annotated, Any, Literal

from pydantic import Field

from neural_shadows.sections.any_report import AnyClaim, AnyFigure, AnyTable
from neural_shadows.sections.compute import Compute
from neural_shadows.sections.experiments import Experiment, RayExperiment, ScreenExperiment
from neural_shadows.sections.frame_sets import VIEWS, FrameSet, RenderedFrames
from neural_shadows.sections.frame_times import FrameTimes
from neural_shadows.sections.learning_curves import LearningCurve
from neural_shadows.sections.metrics import Metrics
from neural_shadows.sections.networks import Network
from neural_shadows.sections.networks_by_scene import NetworksByScene
from neural_shadows.sections.own_frames import OwnFrames
from neural_shadows.sections.samplings import Sampling
from neural_shadows.sections.scenes import STAGE, Arrangement, MeshScene, Scene
from neural_shadows.sections.screen_profiles import ScreenProfiles
from neural_shadows.sections.trainings import Training
from neural_shadows.sections.viewers import Viewer
from neural_shadows.sections.views import Views
from neural_shadows.settings.base import Model, Name, Seed
from neural_shadows.settings.records import CurvePoint

FigureName = Annotated[str, Field(pattern=r"^figure_[a-z0-9_]+$")]
ViewerName = Annotated[str, Field(pattern=r"^viewer(_[a-z0-9_]+)?$")]


class Sections(Model):
    """A configuration; `config.whole` adds kinds of reports."""

    scale: Name = Field(description="name of this configuration and of its folders of results")
    seed: Seed = Field(description="seed of all random draws")
    dragon: str | None = Field(None, min_length=1, description="`wyrm`, `stanford`, or a mesh file")
    up: Literal["x", "y", "z"] | None = Field(
        None, description="vertical axis of the dragon's mesh, overriding its scene's"
    )
    only: str | list[str] | None = Field(
        None,
        description="files whose tables, figures, viewers and claims alone are made, as `hu_2025`",
    )
    compute: Compute = Field(Compute(), description="device, threads and number format of networks")
    scenes: dict[Name, Scene] = Field(
        description="meshes in their unit sphere, and arrangements in metres, by name"
    )
    samplings: dict[Name, Sampling] = Field(description="samplings of training rays, by name")
    networks: dict[Name, Network] = Field(
        description="architectures, on rays by `encoding` or in screen space by `form`, by name"
    )
    trainings: dict[Name, Training] = Field(
        description="trainings, on rays with `batch_size` or on frames with `crops`, by name"
    )
    experiments: dict[Name, Experiment] = Field(
        description="trained networks, on rays of a `scene` or on frames of a `frame_set`, by name"
    )
    learning_curves: dict[Name, LearningCurve] = Field(
        {}, description="trainings at several budgets, from several seeds, by name"
    )
    frame_sets: dict[Name, FrameSet] = Field(
        description="`views` of meshes under a sun, and frames with exact soft shadows, by name"
    )
    networks_by_scene: dict[Name, NetworksByScene] = Field(
        {}, description="methods with one screen-space network per scene, by name"
    )
    screen_profiles: ScreenProfiles = Field(
        ScreenProfiles(), description="timing of screen-space networks by level"
    )
    metrics: Metrics = Field(Metrics(), description="settings of the image metrics")
    frame_times: FrameTimes = Field(FrameTimes(), description="measurement of frame times")
    tables: Mapping[Name, AnyTable] = Field({}, description="tables, by name")
    figures: Mapping[FigureName, AnyFigure] = Field(
        {}, description="figures to draw, by name: `figure_` and the thesis's number"
    )
    viewers: dict[ViewerName, Viewer] = Field(
        {}, description="interactive pages with a movable light, by name: `viewer`, `viewer_NAME`"
    )
    claims: Mapping[Name, AnyClaim] = Field({}, description="conclusions to be judged, by name")

    @cached_property
    def mesh_scenes(self) -> dict[str, MeshScene]:
        """Entries of `scenes` with a mesh."""
        return {k: scene for k, scene in self.scenes.items() if isinstance(scene, MeshScene)}

    def arrangement(self, scene: str) -> Arrangement:
        """A scene in metres; a mesh alone stands on a stage."""
        settings = self.scenes[scene]
        if isinstance(settings, Arrangement):
            return settings
        alone = {"generate": STAGE, "inserted": [scene], "seed": settings.seed, "penumbra": None}
        return Arrangement.model_construct(**alone)

    def layout_seed(self, scene: str) -> int:
        """Seed of a scene's arrangement."""
        seed = self.scenes[scene].seed
        return self.seed if seed is None else seed

    @property
    def views(self) -> Views:
        """Views of meshes under a sun."""
        return self.frame_sets[VIEWS]

    @cached_property
    def soft_frame_sets(self) -> dict[str, RenderedFrames | OwnFrames]:
        """Frame sets under an area light."""
        soft = RenderedFrames | OwnFrames
        return {k: frames for k, frames in self.frame_sets.items() if isinstance(frames, soft)}

    @cached_property
    def ray_experiments(self) -> dict[str, RayExperiment]:
        """Experiments on rays."""
        return {k: e for k, e in self.experiments.items() if isinstance(e, RayExperiment)}

    @cached_property
    def screen_experiments(self) -> dict[str, ScreenExperiment]:
        """Experiments on frames."""
        return {k: e for k, e in self.experiments.items() if isinstance(e, ScreenExperiment)}

    def network_of(self, experiment: str) -> Any:
        """Section of an experiment's network."""
        network = self.experiments[experiment].network
        return self.networks[network] if isinstance(network, str) else network

    def training_of(self, experiment: str) -> Any:
        """Section of an experiment's training, or None."""
        training = self.experiments[experiment].training
        return self.trainings[training] if isinstance(training, str) else training

    def seed_of(self, experiment: str) -> int:
        """An experiment's seed: its own, its scene's or the configuration's."""
        settings = self.experiments[experiment]
        of_scene = self.scenes[settings.scene].seed if isinstance(settings, RayExperiment) else None
        return next(seed for seed in (settings.seed, of_scene, self.seed) if seed is not None)

    def label_of(self, experiment: str, label: str | None = None) -> str:
        """Label of an experiment, with settings in braces filled in.

        Raises:
            ValueError: neither the network nor the training has a setting in braces.
        """
        label = label or self.experiments[experiment].label or experiment
        training = self.training_of(experiment)
        settings = training.model_dump() if training else {}
        settings |= self.network_of(experiment).model_dump()
        try:
            return label.format(**settings)
        except (LookupError, ValueError, TypeError, AttributeError) as error:
            raise ValueError(
                f"experiments.{experiment}.label: {label!r}: braces must name a setting of "
                f"its network or training. Allowed: {', '.join(settings)}"
            ) from error

    @cached_property
    def points(self) -> dict[str, list[CurvePoint]]:
        """Points of the learning curve of each experiment, by steps, frames, then seed.

        The experiment itself is the point of its own steps, frames and seed.
        """
        curves = self.learning_curves.values()
        return {
            name: self._points_of(name, curve) for curve in curves for name in curve.experiments
        }

    def _points_of(self, experiment: str, curve: LearningCurve) -> list[CurvePoint]:
        settings, training = self.experiments[experiment], self.training_of(experiment)
        own_seed = self.seed_of(experiment)
        all_frames = self.frame_sets[settings.frame_set].train if curve.frames else None
        points = []
        for steps, frames, k in product(curve.steps, curve.frames or [None], range(curve.seeds)):
            point: CurvePoint = {"steps": steps, "seed": own_seed + k}
            if curve.frames:
                point |= {"frames": frames, "samples": frames * len(settings.scenes)}
            else:
                point |= {"samples": steps * training.batch_size}
            shipped = getattr(settings, "weights", None)
            own = (steps, frames, k) == (training.steps, all_frames, 0) and not shipped
            of_frames = f"_{frames}_frames" if curve.frames else ""
            name = f"{experiment}{of_frames}_{steps}_steps_seed_{own_seed + k}"
            points.append({"experiment": experiment if own else name, **point})
        return points

    def differences(self, experiment: str, other: str) -> list[str]:
        """Differing keys of two experiments, except `seed` and `label`."""
        first, second = (dict(self.experiments[name]) for name in (experiment, other))
        return [k for k in first if k not in ("seed", "label") and first[k] != second[k]]
