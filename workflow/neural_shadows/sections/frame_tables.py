"""Base classes of tables on frame sets."""

from typing import Annotated, Any, ClassVar, Literal

from pydantic import Field

from neural_shadows.evaluation.registry import FRAME_METHODS, frame_method
from neural_shadows.frames.feature_names import TRACED, buffers_of
from neural_shadows.rendering.light_shape import SPHERE
from neural_shadows.sections.any_report import AnyTable
from neural_shadows.sections.experiments import FRAMES, ScreenExperimentName
from neural_shadows.sections.frame_sets import FrameSetName
from neural_shadows.sections.networks import ScreenNetworkName
from neural_shadows.sections.own_frames import OwnFrames, lacking
from neural_shadows.sections.sections import Sections
from neural_shadows.settings.base import Name, check_among, of_another_kind

# Scenes of a frame set whose test frames count.
OfScenes = Annotated[
    Literal["trained", "unseen"],
    Field(description="whose test frames: those of the set's `scenes` or of its `unseen`"),
]
OfAnyScenes = Annotated[
    Literal["all", "trained", "unseen"],
    Field(
        description="whose test frames: those of all the set's scenes, of its `scenes` or of its `unseen`"
    ),
]


class FramesTable(AnyTable):
    """Common base of tables on a frame set."""

    own_chapter = "networks"
    shown_in: ClassVar[str] = "methods"  # the key of `methods_shown`

    frame_set: FrameSetName = Field(description="a name in `frame_sets`, but `views`")

    def check(self, config: Sections, key: str) -> None:
        """Check the frame set against the table's methods."""
        for method in self.methods_shown():
            check_method(config, f"{key}.{self.shown_in}: {method!r}", self.frame_set, method)


class NsmTable(AnyTable):
    """Table of untrained screen-space networks (Datta et al. 2022, S3, S4.1)."""

    own_chapter = "networks"

    published: str | None = Field(
        None, pattern=r"^nsm\.s[2-5]$", description="`nsm.` and the table's number in the paper"
    )


class ProfileTable(NsmTable):
    """Table of the times of one network."""

    network: ScreenNetworkName = Field(description="a screen-space network of `networks`")


class NetworksTable(FramesTable):
    """Table of trained screen-space networks on a frame set."""

    shown_in = "networks"

    networks: list[ScreenExperimentName] = Field(
        min_length=1, description="experiments on frames, in the table's order"
    )

    def methods_shown(self) -> list[str]:
        return self.networks


class ColumnsTable(FramesTable):
    """Table of trained screen-space networks by the paper's names."""

    shown_in = "columns"

    columns: dict[Name, ScreenExperimentName] = Field(
        min_length=1, description="an experiment on frames for each of the paper's names"
    )

    def methods_shown(self) -> list[str]:
        return [*self.columns.values()]


class MethodsTable(FramesTable):
    """Table of the methods of `methods_shown` on test frames."""

    def needs_sequence(self) -> bool:
        """Check for evaluation on sequences."""
        return False

    def check(self, config: Sections, key: str) -> None:
        """Check methods against the frame set."""
        frames = config.frame_sets[self.frame_set]
        names = [*FRAME_METHODS, *config.screen_experiments, *config.networks_by_scene]
        methods = self.methods_shown()
        for method in methods:
            if method in config.ray_experiments:
                message = of_another_kind(method, FRAMES, config.screen_experiments)
                raise ValueError(f"{key}.methods: {message}")
            check_among(f"{key}.methods", method, names)
            if methods.count(method) > 1:
                raise ValueError(f"{key}.methods: {method!r} is listed twice. List it once")
        super().check(config, key)
        if self.needs_sequence() and not getattr(frames, "sequence", 0):
            raise ValueError(
                f"{key}.frame_set: frame_sets.{self.frame_set} has sequence = 0. Set 2 or more"
            )


def check_penumbrae(config: Sections, key: str, frame_set: str) -> None:
    """Check a frame set for penumbrae in scenes.

    Raises:
        ValueError: a user's own frames, or point lights alone.
    """
    frames = config.frame_sets[frame_set]
    if isinstance(frames, OwnFrames):
        raise ValueError(
            f"{key}.frame_set: {frame_set!r} is of a user's own frames, which have "
            "no scene. Choose another frame set"
        )
    if not any(frames.radii):
        raise ValueError(
            f"{key}.frame_set: {frame_set!r} has lights without extent alone, and so no penumbrae. Choose "
            "another frame set"
        )


def check_method(config: Sections, key: str, frame_set: str, method: str) -> None:
    """Check a frame set's lights and channels against a method.

    Raises:
        ValueError: a network is trained on smaller lights, or on radii in another unit; or the
            user's own frames lack a channel, or the scene that the method needs.
    """
    if method in config.networks_by_scene:
        networks = config.networks_by_scene[method].experiments
    else:
        networks = [method] if method in config.screen_experiments else []
    for experiment in networks:
        _check_network(config, key, frame_set, experiment)
    frames = config.frame_sets[frame_set]
    if isinstance(frames, OwnFrames):
        if not networks and frame_method(method).needs_scene:
            bases = ", ".join(name for name, base in FRAME_METHODS.items() if base.channel)
            raise ValueError(
                f"{key} needs the scene's geometry, and a user's own frames have none. Allowed: {bases}, "
                "and networks"
            )
        features = (config.network_of(experiment).features for experiment in networks)
        buffers = [buffer for names in features for buffer in buffers_of(names)]
        if {*TRACED} & {*buffers}:
            raise ValueError(
                f"{key} filters rays, and a user's own frames have no scene to trace. Use a network of a "
                "shadow map"
            )
        base = FRAME_METHODS[method].channel if method in FRAME_METHODS else None
        if absent := lacking(frames, dict.fromkeys([base] if base else buffers)):
            raise ValueError(f"{key} needs all its channels in frame_sets.{frame_set}: {absent}")


def _check_network(config: Sections, key: str, frame_set: str, experiment: str) -> None:
    learned = config.screen_experiments[experiment]
    seen = {*learned.scenes} & {*getattr(config.frame_sets[frame_set], "unseen", ())}
    if seen and learned.frame_set != frame_set:
        raise ValueError(
            f"{key} is trained on {', '.join(sorted(seen))}, in `unseen` of frame_sets.{frame_set}. Move "
            "that to its `scenes`, or leave the network out"
        )
    frames, trained_on = (
        _radii(config.frame_sets[name]) for name in (frame_set, learned.frame_set)
    )
    if not frames or not trained_on:
        return
    if frames[0] != trained_on[0] and "degrees" in (frames[0], trained_on[0]):
        raise ValueError(
            f"{key} is trained on lights with radii in {trained_on[0]}, and frame_sets.{frame_set} has them "
            f"in {frames[0]}. Train it on frames of such a light, or leave it out"
        )
    if isinstance(config.frame_sets[frame_set], OwnFrames) and frames[0] != trained_on[0]:
        raise ValueError(
            f"{key} is trained on radii in {trained_on[0]}, and frame_sets.{frame_set} has them in "
            f"{frames[0]}. Set its `engine.radius_unit: {trained_on[0]}`, and radii of up to "
            f"{trained_on[1]:g}"
        )
    if frames[0] == trained_on[0] and frames[2] > trained_on[2]:
        own = isinstance(config.frame_sets[frame_set], OwnFrames)
        cure = f"End its `engine.radii` at {trained_on[1]:g}, or train" if own else "Train"
        raise ValueError(
            f"{key} is trained on lights of up to {trained_on[1]:g} {trained_on[0]}, and "
            f"frame_sets.{frame_set} has one of {frames[1]:g}. {cure} it on frames with such a light, "
            "or leave it out"
        )


def _radii(frames: Any) -> tuple[str, float, float] | None:
    """Unit and maximum of the radii, and its `LightShape`'s; None for a user's arrays."""
    frames = getattr(frames, "engine", frames) if isinstance(frames, OwnFrames) else frames
    if not frames:
        return None
    unit, largest = frames.radius_unit, max(frames.radii)
    shape = getattr(frames, "light", SPHERE)
    return unit, largest, shape.radius_of(largest, unit, 1.0)
