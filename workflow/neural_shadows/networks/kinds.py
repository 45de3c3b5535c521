"""The kinds of shadow network: each a module named for the config's `encoding`."""

from importlib import import_module
from typing import Any

from neural_shadows.networks.kind_module import kind_module
from neural_shadows.networks.object_space.shadow_network import ShadowNetwork


def make_network(settings: dict[str, Any]) -> ShadowNetwork:
    """A network from a config's entry: `encoding`, and the arguments of its class.

    `RayGridNetwork` of `ray_grid_network.py` for `ray_grid`: found by name and not in a list,
    so that one more kind changes no file that the others' trainings depend on.

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
    if not str(encoding).isidentifier() or not kind_module(encoding).is_file():
        raise KeyError(f"encoding {encoding!r}")
    path = kind_module(encoding)
    module = import_module(f"neural_shadows.networks.{path.parent.name}.{path.stem}")
    words = path.stem.split("_")
    return getattr(module, "".join(word.capitalize() for word in words))(**arguments)
