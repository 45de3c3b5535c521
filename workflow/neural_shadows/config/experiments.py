"""`experiments`: the networks that are trained."""

from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import Field

from neural_shadows.config.base import Model, Seed, Text, name_in, text_or
from neural_shadows.config.networks import Network
from neural_shadows.config.trainings import Training
from neural_shadows.evaluation.method_names import BIASED_SUFFIX, CLASSIC, NULL, RAY_TRACED

if TYPE_CHECKING:
    from neural_shadows.config.whole import Config


class Experiment(Model):
    """One network: scene + network, and sampling + training of one that is trained."""

    scene: name_in("scenes") = Field(description="a name in `scenes`")
    sampling: name_in("samplings") | None = Field(
        None, description="a name in `samplings`; none for a network that is only built"
    )
    network: text_or(name_in("networks"), Network) = Field(description="a name, or a section")
    training: text_or(name_in("trainings"), Training) | None = Field(
        None, description="a name, or a section; none for a network that is only built"
    )
    seed: Seed | None = Field(None, description="seed of this training; without it the scene's")
    bias: text_or(Literal["held_out"], Annotated[float, Field(ge=0, le=1)]) = Field(
        0.0, description="added to t_pred, in radii; `held_out`: the best on views in no table"
    )
    label: Text | None = Field(
        None, description="its name in tables; may hold settings, as `{resolution}³ field`"
    )


def network_of(config: "Config", experiment: str) -> Any:
    """The section of an experiment's network."""
    network = config.experiments[experiment].network
    return config.networks[network] if isinstance(network, str) else network


def training_of(config: "Config", experiment: str) -> Training | None:
    """The section of an experiment's training; None for a network that is only built."""
    training = config.experiments[experiment].training
    return config.trainings[training] if isinstance(training, str) else training


def seed_of(config: "Config", experiment: str) -> int:
    """An experiment's seed: its own, its scene's or the configuration's."""
    settings = config.experiments[experiment]
    seeds = settings.seed, config.scenes[settings.scene].seed, config.seed
    return next(seed for seed in seeds if seed is not None)


def formatted(config: "Config", experiment: str, label: str | None = None) -> str:
    """A label, the experiment's own if none is given, with the settings that it names.

    Raises:
        ValueError: it names a setting that the experiment's network and training do not have.
    """
    label = label or config.experiments[experiment].label or experiment
    training = training_of(config, experiment)
    settings = training.model_dump() if training else {}
    settings |= network_of(config, experiment).model_dump()
    try:
        return label.format(**settings)
    except (LookupError, ValueError, TypeError, AttributeError) as error:
        raise ValueError(
            f"the label {label!r} of {experiment}: what stands in braces should be a setting of its "
            f"network or training; allowed: {', '.join(settings)}"
        ) from error


def check(config: "Config") -> None:
    """Check names in experiments, and that none is another's twin."""
    trained: dict[str, str] = {}
    for name, experiment in config.experiments.items():
        key = f"experiments.{name}"
        families = tuple(f"{family}_" for family in CLASSIC)
        if name in ("reference", RAY_TRACED, *NULL) or name.startswith(families):
            raise ValueError(f"{key}: a method of tables has a name like this; choose another")
        if name.endswith(BIASED_SUFFIX):
            raise ValueError(
                f"{key}: {BIASED_SUFFIX!r} ends a row's name with a bias; leave it out"
            )
        same = trained.setdefault(experiment.model_dump_json(exclude={"label", "bias"}), name)
        if same != name:
            raise ValueError(
                f"{key}: is the same as experiments.{same}, and would train the same network "
                "twice; use that one, or change the seed"
            )
        _check_training(config, name)
        formatted(config, name)


def _check_training(config: "Config", name: str) -> None:
    """Check that a network has rays and a training if it learns, and none if it cannot."""
    network, key = network_of(config, name), f"experiments.{name}"
    given = {part: getattr(config.experiments[name], part) for part in ("sampling", "training")}
    missing = [part for part, value in given.items() if value is None]
    if not network.trained:
        if len(missing) < 2:
            raise ValueError(
                f"{key}: a network of the kind {network.encoding!r} is built and not trained; "
                "leave out its sampling and training"
            )
    elif not missing and training_of(config, name).optimiser == "muon":
        if network.hidden_matrices == 0:
            raise ValueError(
                f"{key}.training: optimiser = 'muon': is for matrices between two layers of "
                f"neurons, and this network of the kind {network.encoding!r} has none; use adam"
            )
    elif missing and (len(missing) == 1 or getattr(network, "start", "undecided") == "undecided"):
        raise ValueError(
            f"{key}.{missing[0]}: this key is missing; a network that is trained needs a sampling "
            "and a training"
        )
