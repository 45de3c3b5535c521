"""Choice between solid and sheet by a mesh."""

from neural_shadows.networks.settings.object_space import NetworkModel
from neural_shadows.settings.records import MeshReport


def with_surface(network: NetworkModel, mesh: MeshReport) -> NetworkModel:
    """Resolve a network's `surface: auto` by its mesh.

    A field starting from distances is always a solid, because distances need an inside. On an open,
    thin mesh it `is_unfit`.
    """
    if getattr(network, "surface", None) != "auto":
        return network
    from_distances = getattr(network, "start", "undecided") != "undecided"
    sheet = mesh["sheet"] and not from_distances
    return network.model_copy(update={"surface": "sheet" if sheet else "solid"})


def is_unfit(network: NetworkModel, mesh: MeshReport) -> bool:
    """Test for a solid's network with a sheet for a mesh."""
    return getattr(network, "surface", None) == "solid" and mesh["sheet"]
