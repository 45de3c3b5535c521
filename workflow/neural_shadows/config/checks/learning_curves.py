"""Checks of `learning_curves`."""

from neural_shadows.sections.sections import Sections


def check(config: Sections) -> None:
    """Check that networks have trainings and are listed once."""
    names = config.learning_curves.experiments if config.learning_curves else []
    for name in names:
        if config.training_of(name) is None:
            raise ValueError(f"learning_curves.experiments: {name!r} has no training. Remove it")
        if names.count(name) > 1:
            raise ValueError(f"learning_curves.experiments: {name!r} is listed twice. List it once")
