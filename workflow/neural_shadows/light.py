"""The domains that light directions are drawn from, and the basis that goes with a light [4.1]."""

import numpy as np

from neural_shadows.errors import InputError

_AXES = {"x": 0, "y": 1, "z": 2}


def axis_vector(name: str, key: str) -> np.ndarray:
    """Unit vector (3,), float64, of the axis "x", "y" or "z"; `key` is named if it is none.

    Raises:
        InputError: `name` is not one of the three.
    """
    if name not in _AXES:
        raise InputError(f'{key}: {name!r} is not an axis; write "x", "y" or "z"')
    return np.eye(3)[_AXES[name]]


def light_basis(light: np.ndarray) -> np.ndarray:
    """Right-handed orthonormal basis of a light: rows u, v, light; (3, 3) float64.

    u = e × l normalised, e the coordinate axis least aligned with l, the unit vector towards
    the light (the first of equals); v = l × u.
    """
    light = np.asarray(light, np.float64)
    u = np.cross(np.eye(3)[np.argmin(np.abs(light))], light)
    u /= np.linalg.norm(u)
    return np.stack([u, np.cross(light, u), light])


def draw_light(domain: dict, up: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Unit vector (3,) towards the light, float64, drawn from a scene's `light` domain [4.1].

    Args:
        domain: `domain`, and `min_elevation_deg` in [0, 90) above the horizon.
            `sphere`: uniform over the area of the cap of the sphere above that elevation.
            `single_axis`: the sun's path, a half turn about the horizontal `axis` ("x", "y"
            or "z") through the zenith; uniform in the angle, both ends at that elevation.
        up: (3,) unit vector.

    Raises:
        InputError: a value of `domain` is wrong.
    """
    lowest = domain["min_elevation_deg"]
    if not 0 <= lowest < 90:
        raise InputError(f"light.min_elevation_deg: {lowest} is not in [0, 90); give degrees")
    if domain["domain"] == "sphere":
        # Archimedes: area on the sphere is uniform in height.
        height = rng.uniform(np.sin(np.radians(lowest)), 1.0)
        angle = rng.uniform(0.0, 2 * np.pi)
        across = np.sqrt(1 - height**2)
        local = [across * np.cos(angle), across * np.sin(angle), height]
        return np.array(local) @ light_basis(up)
    if domain["domain"] == "single_axis":
        axis = axis_vector(domain["axis"], "light.axis")
        if abs(axis @ up) > 1e-6:
            raise InputError(
                f"light.axis: {domain['axis']} is not horizontal; pick one across `up`"
            )
        angle = np.radians(rng.uniform(lowest - 90, 90 - lowest))
        return np.cos(angle) * up + np.sin(angle) * np.cross(axis, up)
    raise InputError(f"light.domain: {domain['domain']!r} is unknown; use sphere or single_axis")
