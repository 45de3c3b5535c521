"""The lights of soft shadows in reports: their names by their radii, and which of them are shown."""

from collections.abc import Sequence

from neural_shadows.rendering.light_shape import UNITS
from neural_shadows.settings.records import PartRecord

POINT = "point"


def light_names(about: PartRecord) -> list[str]:
    """Names of the lights of a part of a frame set, in order; `about`: its JSON."""
    return [light_name(radius, unit_of(about)) for radius in radii_of(about)]


def light_sizes(about: PartRecord) -> list[str]:
    """Radii of the lights of a part, in words, in order; `about`: its JSON, or its frame set's settings."""
    unit = unit_of(about)
    space = "" if unit == UNITS["degrees"] else " "
    return [f"{radius:.3g}{space}{unit}" if radius else POINT for radius in radii_of(about)]


def radii_of(about: PartRecord) -> list[float]:
    """Radii of a part's lights, as they are configured, in `unit_of`."""
    return about.get("given_radii", about["radii"])


def unit_of(about: PartRecord) -> str:
    """Unit of the radii: m, S for sizes of the scene, or °."""
    return UNITS[about.get("radius_unit", "metres")]


def light_name(radius: float, unit: str) -> str:
    """Name of a light of a radius; `unit`: see `unit_of`."""
    if unit == UNITS["degrees"]:
        return f"sun of {radius:.3g}° radius" if radius else "sun of no extent"
    return f"light of {radius:.3g} {unit} radius" if radius else "point light"


def shown_radii(radii: Sequence[float]) -> list[int]:
    """Numbers of the radii that pictures show: the least but a point, the middle, the largest."""
    last = len(radii) - 1
    return sorted({min(int(radii[0] == 0), last), len(radii) // 2, last})
