"""Shadow networks from their settings."""

from typing import Any

from neural_shadows.networks.kind_module import ENCODINGS
from neural_shadows.networks.object_space.shadow_network import ShadowNetwork
from neural_shadows.settings.kinds import kinds


def make_network(settings: dict[str, Any]) -> ShadowNetwork:
    """A network from a config's entry: `encoding`, and the arguments of its class.

    The class is imported by its kind's file, so that one more kind changes no file that the others'
    trainings depend on.

    Raises:
        KeyError, TypeError: there is no such encoding, or it has other arguments.
        ValueError: its surface is not chosen.
    """
    if settings.get("surface") == "auto":
        raise ValueError(
            "surface: auto: is no surface yet. Let `with_surface` choose it by the mesh."
        )
    arguments = dict(settings)
    encoding = arguments.pop("encoding")
    if encoding not in kinds(ENCODINGS):
        raise KeyError(f"encoding {encoding!r}")
    return kinds(ENCODINGS)[encoding].network_class()(**arguments)
