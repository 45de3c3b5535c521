"""Checks of `experiments`."""

from neural_shadows.evaluation.method_names import BIASED_SUFFIX, PATTERNS, RAY_TRACED
from neural_shadows.sections.sections import Sections


def check(config: Sections) -> None:
    """Check names, duplicates and trainings of experiments."""
    names: dict[str, str] = {}
    for name, experiment in config.experiments.items():
        key = f"experiments.{name}"
        families = tuple(key.removesuffix("N") for key in PATTERNS if key.endswith("_N"))
        if name in ("reference", RAY_TRACED, *PATTERNS) or name.startswith(families):
            raise ValueError(f"{key}: a method of tables has a name like this. Choose another")
        if name.endswith(BIASED_SUFFIX):
            raise ValueError(
                f"{key}: {BIASED_SUFFIX!r} is the ending of rows with a bias. Choose a name without it"
            )
        same = names.setdefault(experiment.model_dump_json(exclude={"label", "bias"}), name)
        if same != name:
            raise ValueError(
                f"{key}: equals experiments.{same}, so that one network would be trained "
                "twice. Use that one, or change the seed"
            )
        _check_training(config, name)
        config.label_of(name)


def _check_training(config: Sections, name: str) -> None:
    """Check for sampling and training where needed, and only there."""
    network, key = config.network_of(name), f"experiments.{name}"
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
