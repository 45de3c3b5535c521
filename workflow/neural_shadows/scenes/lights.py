"""Domains of light directions, and bases of lights [4.1]."""

import numpy as np

from neural_shadows.settings.records import LightSettings


def axis_vector(name: str) -> np.ndarray:
    """Unit vector (3,) float64 of the axis "x", "y" or "z"."""
    return np.eye(3)["xyz".index(name)]


def light_basis(light: np.ndarray) -> np.ndarray:
    """Right-handed orthonormal basis, rows u, v, light; (3, 3) float64.

    u = e × l normalised, e the coordinate axis least aligned with l, the unit vector towards
    the light (the first of equals); v = l × u.
    """
    light = np.asarray(light, np.float64)
    u = np.cross(np.eye(3)[np.argmin(np.abs(light))], light)
    u /= np.linalg.norm(u)
    return np.stack([u, np.cross(light, u), light])


def lowest_elevation(domain: LightSettings) -> float:
    """A light domain's `min_elevation_deg` in radians."""
    return float(np.radians(domain["min_elevation_deg"]))


def arc_directions(domain: LightSettings, up: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """Unit vectors (..., 3) to the light on an arc [4.1.1].

    `angle` (...) is measured from the zenith. The arc is a rotation about the horizontal `axis` of a `single_axis` domain.
    """
    axis = axis_vector(domain["axis"])
    angle = np.asarray(angle)[..., None]
    return np.cos(angle) * up + np.sin(angle) * np.cross(axis, up)


def draw_light(domain: LightSettings, up: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Draw a unit vector (3,) float64 towards the light [4.1].

    Args:
        domain: a scene's `light`: `domain`, and `min_elevation_deg` in [0, 90) above the horizon.
            `sphere`: uniform over the area of the cap of the sphere above that elevation.
            `single_axis`: the sun's path, a half rotation about the horizontal `axis` ("x", "y"
            or "z") through the zenith; uniform in the angle, both ends at that elevation.
        up: (3,) unit vector.
    """
    lowest = lowest_elevation(domain)
    if domain["domain"] == "sphere":
        # Archimedes: area on the sphere is uniform in height.
        height = rng.uniform(np.sin(lowest), 1.0)
        angle = rng.uniform(0.0, 2 * np.pi)
        across = np.sqrt(1 - height**2)
        local = [across * np.cos(angle), across * np.sin(angle), height]
        return np.array(local) @ light_basis(up)
    half = np.pi / 2 - lowest
    return arc_directions(domain, up, rng.uniform(-half, half))
