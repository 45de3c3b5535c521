"""`networks`: on rays by `encoding`, in screen space by `form`."""

from typing import Annotated

from pydantic import Discriminator, Tag

from neural_shadows.networks.settings.networks import RayNetwork, ScreenNetwork
from neural_shadows.settings.base import EntryKind, has_key, name_in

SCREEN = EntryKind("a screen-space network (by `form`)", lambda entry: has_key(entry, "form"))
RAYS = EntryKind("a network on rays (by `encoding`)", lambda entry: not SCREEN.holds(entry))
RayNetworkName, ScreenNetworkName = name_in("networks", RAYS), name_in("networks", SCREEN)

Network = Annotated[
    Annotated[RayNetwork, Tag("Rays")] | Annotated[ScreenNetwork, Tag("Frames")],
    Discriminator(lambda value: "Frames" if SCREEN.holds(value) else "Rays"),
]
