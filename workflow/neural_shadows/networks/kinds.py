"""Shadow networks from their settings."""

from neural_shadows.networks.kind_module import ENCODINGS
from neural_shadows.networks.object_space.shadow_network import ShadowNetwork
from neural_shadows.networks.settings.object_space import NetworkModel
from neural_shadows.settings.kinds import kinds


def make_network(settings: NetworkModel) -> ShadowNetwork:
    """Build a network of its kind's class.

    The kind's file imports the class, so that a new kind changes no file in other trainings'
    digests.

    Raises:
        ValueError: surface: auto.
    """
    arguments = settings.model_dump()
    if arguments.get("surface") == "auto":
        raise ValueError("surface: auto: not resolved for a mesh. Call `with_surface` first.")
    return kinds(ENCODINGS)[arguments.pop("encoding")].network_class()(**arguments)
