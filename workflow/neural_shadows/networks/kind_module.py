"""Files of the kinds of networks."""

from pathlib import Path

from neural_shadows.settings.kinds import PACKAGE

# Networks of one object by `encoding`, screen-space networks by `form`.
ENCODINGS, FORMS = "networks/object_space/kinds", "networks/screen_space/forms"


def kind_module(encoding: str) -> Path:
    """File of a kind of network; `modules_of` follows it to its class."""
    return PACKAGE / ENCODINGS / f"{encoding}.py"


def form_module(form: str) -> Path:
    """File of a form of screen-space network."""
    return PACKAGE / FORMS / f"{form}.py"
