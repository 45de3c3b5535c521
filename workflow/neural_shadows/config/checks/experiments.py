"""Checks of `experiments`."""

from neural_shadows.evaluation.registry import (
    BIASED_SUFFIX,
    FORMATS,
    LABELS,
    PATTERNS,
    RAY_TRACED,
    in_format,
)
from neural_shadows.frames.feature_names import TRACED, buffers_of
from neural_shadows.networks.screen_space.screen_forms import layers_of
from neural_shadows.sections.experiments import RayExperiment, ScreenExperiment
from neural_shadows.sections.frame_sets import RenderedFrames
from neural_shadows.sections.own_frames import OwnFrames, own_parts
from neural_shadows.sections.sections import Sections
from neural_shadows.settings.base import check_among
from neural_shadows.training.settings.frames import ScreenTraining

# Families of methods on meshes, of a resolution each: `shadow_map_512`.
FAMILIES = tuple(key.removesuffix("N") for key in PATTERNS if key.endswith("_N"))


def check_method_name(key: str, name: str) -> None:
    """Check that no other method of tables has the name."""
    if name in ("reference", RAY_TRACED, *PATTERNS, *LABELS) or name.startswith(FAMILIES):
        raise ValueError(f"{key}: a method of tables has a name like this. Choose another")
    if name.endswith(BIASED_SUFFIX):
        raise ValueError(
            f"{key}: {BIASED_SUFFIX!r} is the ending of rows with a bias. Choose a name without it"
        )


def check_name_on_frames(key: str, name: str) -> None:
    """Check the name of a method of networks on frames."""
    check_method_name(key, name)
    for ending in (in_format("", number_format) for number_format in FORMATS):
        if name.endswith(ending):
            raise ValueError(
                f"{key}: {ending!r} is the ending of networks in that number format. Choose a name without it"
            )


def check(config: Sections) -> None:
    """Check names, duplicates, trainings and their data."""
    names: dict[str, str] = {}
    for name, experiment in config.experiments.items():
        key = f"experiments.{name}"
        on_rays = isinstance(experiment, RayExperiment)
        (check_method_name if on_rays else check_name_on_frames)(key, name)
        same = names.setdefault(experiment.model_dump_json(exclude={"label", "bias"}), name)
        if same != name:
            raise ValueError(
                f"{key}: equals experiments.{same}, so that one network would be trained "
                "twice. Use that one, or change the seed"
            )
        (_check_on_rays if on_rays else _check_on_frames)(config, key, name)
        config.label_of(name)


def _check_on_rays(config: Sections, key: str, name: str) -> None:
    """Check for sampling and training where needed, and only there."""
    network = config.network_of(name)
    parts = {part: getattr(config.experiments[name], part) for part in ("sampling", "training")}
    missing = [part for part, value in parts.items() if value is None]
    if not network.trained:
        if len(missing) < 2:
            raise ValueError(
                f"{key}: a network of the kind {network.encoding!r} has no training. "
                "Remove `sampling` and `training`"
            )
    elif not missing and config.training_of(name).optimiser == "muon":
        if network.hidden_matrices == 0:
            raise ValueError(
                f"{key}.training: optimiser = 'muon': needs matrices between two hidden "
                f"layers, and this network of the kind {network.encoding!r} has none. Use adam"
            )
    elif missing and (len(missing) == 1 or network.needs_training):
        raise ValueError(
            f"{key}.{missing[0]}: this key is missing. A trained network needs `sampling` "
            "and `training`"
        )


def _check_on_frames(config: Sections, key: str, name: str) -> None:
    """Check training frames, crops and lights."""
    experiment, training = config.experiments[name], config.training_of(name)
    _check_frames(config, key, name, experiment, training)
    network = config.network_of(name)
    least = 2 ** max(layer.level for layer in layers_of(network))
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


def _check_frames(
    config: Sections, key: str, name: str, experiment: ScreenExperiment, training: ScreenTraining
) -> None:
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
        traced = {*TRACED} & {*buffers_of(config.network_of(name).features)}
        _check_rendered(key, where, frames, training, bool(traced))


def _check_rendered(
    key: str, where: str, frames: RenderedFrames, training: ScreenTraining, traced: bool
) -> None:
    if frames.train == 0:
        raise ValueError(f"{key}.frame_set: {where} has train = 0. Set it to 1 or more")
    if training.perturbation > 0 and frames.twins.count == 0:
        raise ValueError(
            f"{key}.training: perturbation = {training.perturbation:g} needs perturbed frames. Set "
            f"`twins: {{count: 3}}` in {where}, or perturbation: 0"
        )
    if traced and frames.rays == 0:
        raise ValueError(
            f"{key}.network: filters rays, and {where} has rays = 0. Set it to 1 or more"
        )
    if traced and training.perturbation > 0:
        raise ValueError(
            f"{key}.training: perturbation = {training.perturbation:g}: perturbed frames have no rays, "
            "which the network filters. Set perturbation: 0"
        )
