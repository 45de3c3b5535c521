"""Networks of Neural Shadow Mapping, trimmed or not, from their settings."""

from typing import Any

from neural_shadows.frames.feature_names import channels_of
from neural_shadows.networks.screen_space import widths
from neural_shadows.networks.settings.screen_space import AnyScreenNetwork


def convolutions(settings: AnyScreenNetwork) -> list[widths.Convolution]:
    """All convolutions, in order of computation."""
    chosen = settings.model_dump(include={"form", "widths", "extraction"})
    return widths.convolutions(**chosen, channels=channels_of(settings.features))


def network(settings: AnyScreenNetwork) -> Any:
    """A network of visibility or of an exponent."""
    from neural_shadows.networks.screen_space.exponent_unet import ExponentUnet
    from neural_shadows.networks.screen_space.shadow_unet import ShadowUnet

    of_exponent = getattr(settings, "answer", "visibility") == "exponent"
    unet = ExponentUnet if of_exponent else ShadowUnet
    return unet(**settings.model_dump(exclude={"answer"}))
