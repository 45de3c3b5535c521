"""Whether a network takes its object for a solid or for a sheet, and whether it can."""

from collections.abc import Mapping
from typing import Any


def with_surface(network: Mapping[str, Any], mesh: Mapping[str, Any]) -> dict[str, Any]:
    """A network's settings with a `surface` of `auto` replaced by what its mesh has.

    A field that starts from distances is one of a solid whatever the mesh is: distances need an
    inside. On an open, thin mesh it `is_unfit`.

    Args:
        mesh: what `prepare_mesh` wrote of it.
    """
    if network.get("surface") != "auto":
        return dict(network)
    from_distances = network.get("start", "undecided") != "undecided"
    sheet = mesh["sheet"] and not from_distances
    return {**network, "surface": "sheet" if sheet else "solid"}


def is_unfit(network: Mapping[str, Any], mesh: Mapping[str, Any]) -> bool:
    """Whether a network needs an inside, and its mesh is open and thin and has none."""
    return network.get("surface") == "solid" and mesh["sheet"]
