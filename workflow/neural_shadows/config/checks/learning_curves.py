"""What must hold of `learning_curves`."""

from neural_shadows.sections.sections import Sections


def check(config: Sections) -> None:
    """Check that each network of a learning curve is trained, and there once."""
    names = config.learning_curves.experiments if config.learning_curves else []
    for name in names:
        if config.training_of(name) is None:
            raise ValueError(f"learning_curves.experiments: {name!r} is not trained; leave it out")
        if names.count(name) > 1:
            raise ValueError(f"learning_curves.experiments: {name!r} is there twice")
