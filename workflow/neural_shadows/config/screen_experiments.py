"""`screen_experiments`: the networks of whole frames that are trained."""

from typing import TYPE_CHECKING, Annotated, Any

from pydantic import Field

from neural_shadows.config.base import Model, Seed, Text, check_among, name_in, text_or
from neural_shadows.config.own_frames import OwnFrames, own_parts
from neural_shadows.config.screen_networks import ScreenNetwork
from neural_shadows.config.screen_trainings import ScreenTraining
from neural_shadows.evaluation.soft_method_names import FORMATS, LABELS, in_format
from neural_shadows.networks.screen_space.kernel_widths import KERNEL_FORMS, layers_of

if TYPE_CHECKING:
    from neural_shadows.config.whole import Config


class ScreenExperiment(Model):
    """One network: its shape, its training, and the frames that it learns from."""

    network: text_or(name_in("screen_networks"), ScreenNetwork) = Field(
        description="a name, or a section"
    )
    training: text_or(name_in("screen_trainings"), ScreenTraining) = Field(
        description="a name, or a section"
    )
    frame_set: name_in("frame_sets") = Field(description="a name in `frame_sets`")
    scenes: list[str] = Field(
        min_length=1, description="of the frame set's `scenes`: it learns from these alone"
    )
    lights: list[Annotated[int, Field(ge=0)]] | None = Field(
        None,
        min_length=1,
        description="numbers of the frame set's radii, from 0, that it learns; without it all",
    )
    seed: Seed | None = Field(None, description="of this training; without it the configuration's")
    label: Text | None = Field(None, description="its name in tables")


def network_of(config: "Config", experiment: str) -> Any:
    """The section of an experiment's network."""
    network = config.screen_experiments[experiment].network
    return config.screen_networks[network] if isinstance(network, str) else network


def training_of(config: "Config", experiment: str) -> ScreenTraining:
    """The section of an experiment's training."""
    training = config.screen_experiments[experiment].training
    return config.screen_trainings[training] if isinstance(training, str) else training


def as_settings(config: "Config", name: str) -> dict[str, Any]:
    """An experiment as rules look it up: its sections, and the `trunk` of its perceptual distance; in
    its training the `lights` that it learns.

    Without a trunk the distance is `none`.
    """
    experiment = config.screen_experiments[name]
    training = training_of(config, name).model_dump() | {"lights": experiment.lights}
    perceptual, lpips = training["perceptual"], config.metrics.lpips
    trunk = perceptual.pop("trunk", None)
    if perceptual["net"] == "squeeze":
        trunk = lpips.trunk if lpips.net == "squeeze" else None
        if trunk is None:
            training["perceptual"] = {"net": "none"}
    return experiment.model_dump() | {
        "network": network_of(config, name).model_dump(),
        "training": training,
        "trunk": trunk,
        "seed": config.seed if experiment.seed is None else experiment.seed,
        "label": experiment.label or name,
    }


def differences(config: "Config", one: str, other: str) -> list[str]:
    """The keys in which two experiments differ, but for `seed` and `label`."""
    first, second = (dict(config.screen_experiments[name]) for name in (one, other))
    return [key for key in first if key not in ("seed", "label") and first[key] != second[key]]


def check_method_name(key: str, name: str) -> None:
    """Check that a trained method is not called as another one of soft tables is."""
    if name in LABELS:
        raise ValueError(f"{key}: a method of soft tables has this name; choose another")
    for ending in (in_format("", one) for one in FORMATS):
        if name.endswith(ending):
            raise ValueError(
                f"{key}: {ending!r} ends the name of a network in that number format; leave it out"
            )


def check(config: "Config") -> None:
    """Check that each network has frames to learn from, and crops that it can take."""
    trained: dict[str, str] = {}
    for name, experiment in config.screen_experiments.items():
        key = f"screen_experiments.{name}"
        check_method_name(key, name)
        if name in config.experiments:
            raise ValueError(f"{key}: an entry of `experiments` has this name; choose another")
        same = trained.setdefault(experiment.model_dump_json(exclude={"label"}), name)
        if same != name:
            raise ValueError(
                f"{key}: is the same as screen_experiments.{same}, and would train the same network "
                "twice; use that one, or change the seed"
            )
        _check_frames(config, name)
        network = network_of(config, name)
        least = 2 ** max(layer.level for layer in layers_of(network.model_dump()))
        if training_of(config, name).crop < least:
            raise ValueError(
                f"{key}.training: crop = {training_of(config, name).crop}: the network's deepest level "
                f"is 1/{least} of a frame; give {least} pixels or more"
            )
        if network.form in KERNEL_FORMS and training_of(config, name).crops % 2:
            raise ValueError(
                f"{key}.training: crops = {training_of(config, name).crops}: the network's batch norms "
                "see two crops at a time; give an even number"
            )


def _check_frames(config: "Config", name: str) -> None:
    key, experiment = f"screen_experiments.{name}", config.screen_experiments[name]
    frames, where = config.frame_sets[experiment.frame_set], f"frame_sets.{experiment.frame_set}"
    own = isinstance(frames, OwnFrames)
    if len(set(experiment.scenes)) < len(experiment.scenes):
        raise ValueError(f"{key}.scenes = {experiment.scenes}: must name each only once")
    for scene in experiment.scenes:
        if scene in getattr(frames, "unseen", ()):
            raise ValueError(
                f"{key}.scenes: {scene!r} is among `unseen` of {where}, which no network may train "
                f"on; allowed: {', '.join(frames.scenes)}"
            )
        check_among(f"{key}.scenes", scene, own_parts(frames) if own else frames.scenes)
    radii = None if own else frames.radii
    if radii is not None and max(experiment.lights or [0]) >= len(radii):
        raise ValueError(
            f"{key}.lights = {experiment.lights}: {where} has {len(radii)} radii, counted from 0"
        )
    if not own:  # of a user's own, the stage looks at the files
        _check_rendered(key, where, frames, training_of(config, name))


def _check_rendered(key: str, where: str, frames: Any, training: ScreenTraining) -> None:
    if frames.train == 0:
        raise ValueError(f"{key}.frame_set: {where} has train = 0; set it to 1 or more")
    if training.perturbation > 0 and frames.twins.count == 0:
        raise ValueError(
            f"{key}.training: perturbation = {training.perturbation:g} needs twins; give {where} "
            "`twins: {count: 3}`, or set perturbation: 0"
        )
