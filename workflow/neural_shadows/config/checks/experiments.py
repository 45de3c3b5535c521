"""What must hold of `experiments`."""

from neural_shadows.evaluation.method_names import BIASED_SUFFIX, PATTERNS, RAY_TRACED
from neural_shadows.sections.sections import Sections


def check(config: Sections) -> None:
    """Check names in experiments, and that none is another's twin."""
    trained: dict[str, str] = {}
    for name, experiment in config.experiments.items():
        key = f"experiments.{name}"
        families = tuple(key.removesuffix("N") for key in PATTERNS if key.endswith("_N"))
        if name in ("reference", RAY_TRACED, *PATTERNS) or name.startswith(families):
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
        config.label_of(name)


def _check_training(config: Sections, name: str) -> None:
    """Check that a network has rays and a training if it learns, and none if it cannot."""
    network, key = config.network_of(name), f"experiments.{name}"
    given = {part: getattr(config.experiments[name], part) for part in ("sampling", "training")}
    missing = [part for part, value in given.items() if value is None]
    if not network.trained:
        if len(missing) < 2:
            raise ValueError(
                f"{key}: a network of the kind {network.encoding!r} is built and not trained; "
                "leave out its sampling and training"
            )
    elif not missing and config.training_of(name).optimiser == "muon":
        if network.hidden_matrices == 0:
            raise ValueError(
                f"{key}.training: optimiser = 'muon': is for matrices between two layers of "
                f"neurons, and this network of the kind {network.encoding!r} has none; use adam"
            )
    elif missing and (len(missing) == 1 or network.needs_training):
        raise ValueError(
            f"{key}.{missing[0]}: this key is missing; a network that is trained needs a sampling "
            "and a training"
        )
