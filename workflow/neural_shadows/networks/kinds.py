"""Shadow networks from their settings."""

from typing import Any

from neural_shadows.networks.kind_module import ENCODINGS
from neural_shadows.networks.object_space.shadow_network import ShadowNetwork
from neural_shadows.settings.kinds import kinds


def make_network(settings: dict[str, Any]) -> ShadowNetwork:
    """Build a network from `encoding` and its class's arguments.

    The kind's file imports the class, so that a new kind changes no file in other trainings'
    digests.

    Raises:
        KeyError, TypeError: unknown encoding or arguments.
        ValueError: surface: auto.
    """
    if settings.get("surface") == "auto":
        raise ValueError("surface: auto: not resolved for a mesh. Call `with_surface` first.")
    arguments = dict(settings)
    encoding = arguments.pop("encoding")
    if encoding not in kinds(ENCODINGS):
        raise KeyError(f"encoding {encoding!r}")
    return kinds(ENCODINGS)[encoding].network_class()(**arguments)
