"""Base classes of tables on frame sets."""

from typing import Any, ClassVar

from pydantic import Field

from neural_shadows.evaluation.soft_registry import METHODS, needs_scene
from neural_shadows.sections.any_report import AnyTable, Chapter
from neural_shadows.sections.own_frames import OwnFrames
from neural_shadows.sections.sections import Sections
from neural_shadows.settings.base import check_among, name_in


class FramesTable(AnyTable):
    """Common base of tables on a frame set."""

    chapter: ClassVar[Chapter] = "soft"

    frame_set: name_in("frame_sets") = Field(description="a name in `frame_sets`")


class NsmTable(AnyTable):
    """Table of untrained screen-space networks (Datta et al. 2022, S3, S4.1)."""

    chapter: ClassVar[Chapter] = "soft"

    published: str | None = Field(
        None, pattern=r"^nsm\.s[2-5]$", description="`nsm.` and the table's number in the paper"
    )


class ProfileTable(NsmTable):
    """Table of the times of one network."""

    network: name_in("screen_networks") = Field(description="a name in `screen_networks`")


class NetworksTable(FramesTable):
    """Table of trained screen-space networks on a frame set."""

    networks: list[name_in("screen_experiments")] = Field(
        min_length=1, description="names in `screen_experiments`, in the table's order"
    )

    def methods_shown(self) -> list[str]:
        return self.networks


class MethodsTable(FramesTable):
    """Table of the methods of `methods_shown` on test frames."""

    def needs_sequence(self) -> bool:
        """Check for evaluation on sequences."""
        return False

    def check(self, config: Sections, key: str) -> None:
        """Check methods against the frame set."""
        frames = config.frame_sets[self.frame_set]
        own = isinstance(frames, OwnFrames)
        names = [*METHODS, *config.screen_experiments, *config.networks_by_scene]
        methods = self.methods_shown()
        for method in methods:
            check_among(f"{key}.methods", method, names)
            if methods.count(method) > 1:
                raise ValueError(f"{key}.methods: {method!r} is listed twice. List it once")
            if own and needs_scene(method):
                bases = ", ".join(name for name, base in METHODS.items() if base.channel)
                raise ValueError(
                    f"{key}.methods: {method!r} needs the scene's geometry, and a user's own frames have "
                    f"none. Allowed: {bases}, and networks"
                )
            if method in config.screen_experiments:
                _check_network(config, f"{key}.methods: {method!r}", self.frame_set, method)
        if self.needs_sequence() and not getattr(frames, "sequence", 0):
            raise ValueError(
                f"{key}.frame_set: frame_sets.{self.frame_set} has sequence = 0. Set 2 or more"
            )


def _check_network(config: Sections, key: str, frame_set: str, experiment: str) -> None:
    """Reject test lights larger than those of the training."""
    frames, trained_on = (
        _radii(config.frame_sets[name])
        for name in (frame_set, config.screen_experiments[experiment].frame_set)
    )
    if frames and trained_on and frames[0] == trained_on[0] and frames[1] > trained_on[1]:
        raise ValueError(
            f"{key} is trained on lights of up to {trained_on[1]:g} {trained_on[0]}, and "
            f"frame_sets.{frame_set} has one of {frames[1]:g}. Train it on frames with such a light, "
            "or leave it out"
        )


def _radii(frames: Any) -> tuple[str, float] | None:
    """Unit and maximum of the radii; None for a user's arrays."""
    frames = getattr(frames, "engine", frames) if isinstance(frames, OwnFrames) else frames
    return frames and (frames.radius_unit.replace("_", " "), max(frames.radii))
