"""Checks of `learning_curves`."""

from neural_shadows.sections import experiments
from neural_shadows.sections.frame_sets import RenderedFrames
from neural_shadows.sections.learning_curves import LearningCurve
from neural_shadows.sections.sections import Sections
from neural_shadows.settings.base import of_another_kind


def check(config: Sections) -> None:
    """Check that networks have trainings of one kind, and are listed once."""
    curves: dict[str, str] = {}
    for curve_name, curve in config.learning_curves.items():
        key = f"learning_curves.{curve_name}"
        on_frames = curve.frames is not None
        kind = experiments.FRAMES if on_frames else experiments.RAYS
        allowed = config.screen_experiments if on_frames else config.ray_experiments
        for name in curve.experiments:
            if name not in allowed:
                hint = "" if on_frames else ". Those on frames need `frames`"
                message = of_another_kind(name, kind, allowed)
                raise ValueError(f"{key}.experiments: {message}{hint}")
            if config.training_of(name) is None:
                raise ValueError(f"{key}.experiments: {name!r} has no training. Remove it")
            if name in curves:
                raise ValueError(f"{key}.experiments: {name!r} is listed twice. List it once")
            curves[name] = curve_name
            if on_frames:
                _check_frames(config, key, curve, name)


def _check_frames(config: Sections, key: str, curve: LearningCurve, name: str) -> None:
    """Check a network's schedule, and that budgets are whole files."""
    if config.training_of(name).schedule == "steps":
        raise ValueError(
            f"{key}.experiments: {name!r} lowers its rate at fixed steps. Use a training of another `schedule`"
        )
    where = f"frame_sets.{config.experiments[name].frame_set}"
    frames = config.frame_sets[config.experiments[name].frame_set]
    if not isinstance(frames, RenderedFrames):
        raise ValueError(f"{key}.experiments: {name!r} has frames of the user's. Leave it out")
    for budget in curve.frames:
        if budget > frames.train or (budget % frames.shard and budget != frames.train):
            raise ValueError(
                f"{key}.frames: {budget}: should be whole files of {where}, {frames.shard} frames each, and "
                f"no more than its train = {frames.train}"
            )
