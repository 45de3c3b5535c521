"""Choice between solid and sheet by a mesh."""

from collections.abc import Mapping
from typing import Any


def with_surface(network: Mapping[str, Any], mesh: Mapping[str, Any]) -> dict[str, Any]:
    """Resolve a network's `surface: auto` by its mesh.

    A field starting from distances is always a solid, because distances need an inside. On an open,
    thin mesh it `is_unfit`.

    Args:
        mesh: JSON of `prepare_mesh`.
    """
    if network.get("surface") != "auto":
        return dict(network)
    from_distances = network.get("start", "undecided") != "undecided"
    sheet = mesh["sheet"] and not from_distances
    return {**network, "surface": "sheet" if sheet else "solid"}


def is_unfit(network: Mapping[str, Any], mesh: Mapping[str, Any]) -> bool:
    """Test for a solid's network with a sheet for a mesh."""
    return network.get("surface") == "solid" and mesh["sheet"]
