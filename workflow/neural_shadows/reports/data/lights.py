"""Names of the lights of soft shadows, by their radii."""

from neural_shadows.settings.records import PartRecord

UNITS = {"metres": "m", "scene_sizes": "S"}


def light_names(about: PartRecord) -> list[str]:
    """Names of the lights of a part of a frame set, in order; `about`: its JSON."""
    unit = UNITS[about.get("radius_unit", "metres")]
    return [light_name(radius, unit) for radius in about.get("given_radii", about["radii"])]


def light_name(radius: float, unit: str) -> str:
    """Name of a light of a radius; `unit`: m, or S for sizes of the scene."""
    return f"light of {radius:.3g} {unit} radius" if radius else "point light"
