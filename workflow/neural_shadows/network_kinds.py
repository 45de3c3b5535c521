"""The kinds of shadow network, by the config's `encoding`."""

from typing import Any

from neural_shadows.frequency_network import FrequencyNetwork
from neural_shadows.grid_network import GridNetwork
from neural_shadows.occupancy_field import OccupancyField
from neural_shadows.shadow_network import ShadowNetwork

KINDS: dict[str, type[ShadowNetwork]] = {
    "frequency": FrequencyNetwork,
    "ray_grid": GridNetwork,
    "occupancy_ray_grid": GridNetwork,
    "hash_grid": GridNetwork,
    "occupancy_field": OccupancyField,
}


def make_network(settings: dict[str, Any]) -> ShadowNetwork:
    """A network from a config's entry: `encoding`, and the arguments of its class.

    Raises:
        KeyError, TypeError: there is no such encoding, or it has other arguments.
    """
    arguments = dict(settings)
    return KINDS[arguments.pop("encoding")](**arguments)
