"""Forms of screen-space networks, by name."""

from collections.abc import Mapping
from types import ModuleType
from typing import Any

from neural_shadows.networks.kind_module import FORMS
from neural_shadows.networks.screen_space.widths import Convolution
from neural_shadows.settings.base import not_among
from neural_shadows.settings.kinds import kinds


def form_of(settings: Mapping[str, Any]) -> ModuleType:
    """Form of an entry of the config's `screen_networks`.

    Raises:
        KeyError, ValueError: unknown form.
    """
    if settings["form"] not in kinds(FORMS):
        raise ValueError(f"form {not_among(str(settings['form']), kinds(FORMS))}")
    return kinds(FORMS)[settings["form"]]


def layers_of(settings: Mapping[str, Any]) -> list[Convolution]:
    """Convolutions of an entry of `screen_networks`, in order."""
    return form_of(settings).convolutions(settings)
