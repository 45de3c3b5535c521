"""Settings of any network: on rays by `encoding`, in screen space by `form`."""

from typing import Any

from pydantic import TypeAdapter, ValidationError

from neural_shadows.networks.kind_module import ENCODINGS, FORMS
from neural_shadows.networks.settings.object_space import NetworkModel
from neural_shadows.networks.settings.screen_space import AnyScreenNetwork
from neural_shadows.settings.kinds import union

RayNetwork = union(ENCODINGS, "frequency", key="encoding")
# Screen-space networks (Datta et al. 2022, 3.5; Hu et al. 2025, 4.2.1).
ScreenNetwork = union(FORMS, key="form")

_RAY, _SCREEN = TypeAdapter(RayNetwork), TypeAdapter(ScreenNetwork)


def ray_network(values: dict[str, Any]) -> NetworkModel:
    """Settings of a network on rays from plain data; ValueError."""
    return _checked(_RAY, values)


def screen_network(values: dict[str, Any]) -> AnyScreenNetwork:
    """Settings of a screen-space network from plain data; ValueError."""
    return _checked(_SCREEN, values)


def _checked(adapter: TypeAdapter, values: dict[str, Any]) -> Any:
    try:
        return adapter.validate_python(values)
    except ValidationError as error:
        first = error.errors()[0]
        key = ".".join(map(str, first["loc"][1:]))
        raise ValueError(f"{key}: {first['msg']}" if key else first["msg"]) from error
