"""Checks of `screen_experiments`."""

from typing import Any

from neural_shadows.evaluation.soft_registry import FORMATS, LABELS, in_format
from neural_shadows.networks.screen_space.screen_forms import layers_of
from neural_shadows.sections.own_frames import OwnFrames, own_parts
from neural_shadows.sections.screen_trainings import ScreenTraining
from neural_shadows.sections.sections import Sections
from neural_shadows.settings.base import check_among


def check_method_name(key: str, name: str) -> None:
    """Check that no other method of soft tables has the name."""
    if name in LABELS:
        raise ValueError(f"{key}: a method of soft tables has this name. Choose another")
    for ending in (in_format("", number_format) for number_format in FORMATS):
        if name.endswith(ending):
            raise ValueError(
                f"{key}: {ending!r} is the ending of networks in that number format. Choose a name without it"
            )


def check(config: Sections) -> None:
    """Check names, duplicates, training frames and crops."""
    names: dict[str, str] = {}
    for name, experiment in config.screen_experiments.items():
        key = f"screen_experiments.{name}"
        check_method_name(key, name)
        if name in config.experiments:
            raise ValueError(f"{key}: an entry of `experiments` has this name. Choose another")
        same = names.setdefault(experiment.model_dump_json(exclude={"label"}), name)
        if same != name:
            raise ValueError(
                f"{key}: equals screen_experiments.{same}, so that one network would be trained "
                "twice. Use that one, or change the seed"
            )
        _check_frames(config, name)
        network, training = config.screen_network_of(name), config.screen_training_of(name)
        least = 2 ** max(layer.level for layer in layers_of(network.model_dump()))
        if training.crop < least:
            raise ValueError(
                f"{key}.training: crop = {training.crop}: the network's deepest level is 1/{least} "
                f"of a frame. Set {least} or more"
            )
        if network.crops_in_pairs and training.crops % 2:
            raise ValueError(
                f"{key}.training: crops = {training.crops}: the network's batch norms take two "
                "crops at a time. Set an even number"
            )


def _check_frames(config: Sections, name: str) -> None:
    key, experiment = f"screen_experiments.{name}", config.screen_experiments[name]
    frames, where = config.frame_sets[experiment.frame_set], f"frame_sets.{experiment.frame_set}"
    own = isinstance(frames, OwnFrames)
    if len(set(experiment.scenes)) < len(experiment.scenes):
        raise ValueError(f"{key}.scenes = {experiment.scenes}: must name each scene once")
    for scene in experiment.scenes:
        if scene in getattr(frames, "unseen", ()):
            raise ValueError(
                f"{key}.scenes: {scene!r} is in `unseen` of {where}, which is for tests only. "
                f"Allowed: {', '.join(frames.scenes)}"
            )
        check_among(f"{key}.scenes", scene, own_parts(frames) if own else frames.scenes)
    radii = None if own else frames.radii
    if radii is not None and max(experiment.lights or [0]) >= len(radii):
        raise ValueError(
            f"{key}.lights = {experiment.lights}: {where} has {len(radii)} radii, counted from 0"
        )
    if not own:  # the stage checks a user's files
        _check_rendered(key, where, frames, config.screen_training_of(name))


def _check_rendered(key: str, where: str, frames: Any, training: ScreenTraining) -> None:
    if frames.train == 0:
        raise ValueError(f"{key}.frame_set: {where} has train = 0. Set it to 1 or more")
    if training.perturbation > 0 and frames.twins.count == 0:
        raise ValueError(
            f"{key}.training: perturbation = {training.perturbation:g} needs perturbed frames. Set "
            f"`twins: {{count: 3}}` in {where}, or perturbation: 0"
        )
