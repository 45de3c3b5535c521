"""Forms of screen-space networks, by name."""

from types import ModuleType

from neural_shadows.networks.kind_module import FORMS
from neural_shadows.networks.screen_space.widths import Convolution
from neural_shadows.networks.settings.screen_space import AnyScreenNetwork
from neural_shadows.settings.kinds import kinds


def form_of(settings: AnyScreenNetwork) -> ModuleType:
    """Module of a network's form."""
    return kinds(FORMS)[settings.form]


def layers_of(settings: AnyScreenNetwork) -> list[Convolution]:
    """Convolutions of a network, in order."""
    return form_of(settings).convolutions(settings)
