"""The files of the kinds of networks."""

from pathlib import Path

from neural_shadows.settings.kinds import PACKAGE

# Of one object by `encoding`, and of whole frames by `form`.
ENCODINGS, FORMS = "networks/object_space/kinds", "networks/screen_space/forms"


def kind_module(encoding: str) -> Path:
    """The file of a kind of network; `modules_of` follows it to its class."""
    return PACKAGE / ENCODINGS / f"{encoding}.py"


def form_module(form: str) -> Path:
    """The same of a form of network of whole frames."""
    return PACKAGE / FORMS / f"{form}.py"
