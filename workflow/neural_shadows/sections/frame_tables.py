"""What tables of methods on the frames of a frame set have in common."""

from typing import Any, ClassVar

from pydantic import Field

from neural_shadows.evaluation.soft_registry import METHODS, needs_scene
from neural_shadows.sections.any_report import AnyTable, Chapter
from neural_shadows.sections.own_frames import OwnFrames
from neural_shadows.sections.sections import Sections
from neural_shadows.settings.base import check_among, name_in


class FramesTable(AnyTable):
    """A table of a frame set."""

    chapter: ClassVar[Chapter] = "soft"

    frame_set: name_in("frame_sets") = Field(description="a name in `frame_sets`")


class NsmTable(AnyTable):
    """A table of screen-space networks without a training (Datta et al. 2022, S3, S4.1)."""

    chapter: ClassVar[Chapter] = "soft"

    published: str | None = Field(
        None, pattern=r"^nsm\.s[2-5]$", description="`nsm.` and the paper's number of this table"
    )


class MethodsTable(FramesTable):
    """A table of methods on a frame set's test frames; a kind says which by `methods_shown`."""

    def needs_sequence(self) -> bool:
        """Whether it is of sequences."""
        return False

    def check(self, config: Sections, key: str) -> None:
        """Check that its methods are known, and can be evaluated on its frames."""
        frames = config.frame_sets[self.frame_set]
        own = isinstance(frames, OwnFrames)
        known = [*METHODS, *config.screen_experiments, *config.networks_by_scene]
        methods = self.methods_shown()
        for method in methods:
            check_among(f"{key}.methods", method, known)
            if methods.count(method) > 1:
                raise ValueError(f"{key}.methods: {method!r} is there twice; should be there once")
            if own and needs_scene(method):
                bases = ", ".join(name for name, one in METHODS.items() if one.channel)
                raise ValueError(
                    f"{key}.methods: {method!r} needs a scene to look at, and frames of a user's own "
                    f"have none; allowed: {bases}, and networks"
                )
            if method in config.screen_experiments:
                _check_network(config, f"{key}.methods: {method!r}", self.frame_set, method)
        if self.needs_sequence() and not getattr(frames, "sequence", 0):
            raise ValueError(f"{key}.frame_set: frame_sets.{self.frame_set} has sequence = 0")


def _check_network(config: Sections, key: str, frame_set: str, experiment: str) -> None:
    """Check that the lights of a frame set are not larger than those that a network trains on."""
    frames, trained_on = (
        _radii(config.frame_sets[name])
        for name in (frame_set, config.screen_experiments[experiment].frame_set)
    )
    if frames and trained_on and frames[0] == trained_on[0] and frames[1] > trained_on[1]:
        raise ValueError(
            f"{key} trains on lights of up to {trained_on[1]:g} {trained_on[0]}, and "
            f"frame_sets.{frame_set} has one of {frames[1]:g}. Train it on frames with such a light, "
            "or leave it out"
        )


def _radii(frames: Any) -> tuple[str, float] | None:
    """The unit of a frame set's radii and the largest; None of a user's own arrays."""
    frames = getattr(frames, "engine", frames) if isinstance(frames, OwnFrames) else frames
    return frames and (frames.radius_unit.replace("_", " "), max(frames.radii))
